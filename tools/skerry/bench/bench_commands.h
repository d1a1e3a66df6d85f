#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/skerry/scene/arguments.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry bench mesh|generate|world|upload|cull|device|lights|shade|frame|flicker|
/// pops|edit|fly|start`: options, and which function each calls.
class BenchCommands {
 public:
  /// Adds `bench` and its sub-commands.
  explicit BenchCommands(CLI::App& app);
  BenchCommands(const BenchCommands&) = delete;
  BenchCommands& operator=(const BenchCommands&) = delete;

  const CLI::App* command() const { return bench_; }
  /// @pre `bench` was given. @return the exit status.
  int run();

 private:
  CLI::App* add(const char* name, const char* description);
  void add_device_options(CLI::App& command);
  int run_mesh();
  int run_on_device(const CLI::App& chosen);
  int run_lights();
  int run_shade();
  int run_frame();
  int run_flicker();
  int run_pops();
  int run_edit();
  int run_flight(const CLI::App& chosen);
  int refuse_unknown() const;

  CLI::App* bench_;
  CLI::App* mesh_;
  CLI::App* generate_;
  CLI::App* world_;
  CLI::App* upload_;
  CLI::App* cull_;
  CLI::App* costs_;
  CLI::App* lights_;
  CLI::App* shade_;
  CLI::App* frame_;
  CLI::App* flicker_;
  CLI::App* pops_;
  CLI::App* edit_;
  CLI::App* fly_;
  CLI::App* start_;
  std::optional<std::string> input_, json_, device_;
  std::optional<double> speed_, seconds_;
  double clock_rate_ = 0.0;
  std::optional<int> frames_;
  std::vector<std::string> only_;
  bool validate_ = false;
  SceneArguments scene_;
};

}  // namespace skerry::tools
