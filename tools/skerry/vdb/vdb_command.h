#pragma once
#include <optional>
#include <string>

#include "tools/skerry/scene/arguments.h"

namespace CLI {
class App;
}

namespace skerry::tools {

/// `skerry vdb info|import|export`: options, and what each does (docs/openvdb.md).
class VdbCommand {
 public:
  /// Adds `vdb` and its sub-commands.
  explicit VdbCommand(CLI::App& app);
  VdbCommand(const VdbCommand&) = delete;
  VdbCommand& operator=(const VdbCommand&) = delete;

  const CLI::App* command() const { return vdb_; }
  /// @pre `vdb` was given. @return the exit status.
  int run();

 private:
  CLI::App* add(const char* name, const char* description);
  void add_expect(CLI::App& command);
  void add_import();
  void add_export();
  int run_info();
  int run_import();
  int run_export();
  int refuse_unknown() const;

  CLI::App* vdb_;
  CLI::App* info_;
  CLI::App* import_;
  CLI::App* export_;
  std::string file_;
  std::optional<std::string> expect_;  ///< of info and import
  bool json_ = false, partial_ = false;
  std::optional<std::string> grid_, scale_, size_, threshold_, up_;  ///< of import
  std::optional<std::string> seed_, world_, box_;                    ///< of export
  std::optional<std::string> out_;
};

}  // namespace skerry::tools
