// The program skerry_openexr: the only one that runs OpenEXR (read_exr.h).
//   skerry_openexr MEMORY_BYTES ANSWER_BYTES CPU_SECONDS read     < an .exr file > an answer
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfThreading.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <glm/common.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vector_relational.hpp>
#include <optional>
#include <string>
#include <vector>

#include "game/openexr/panorama_answer.h"
#include "world/confined/child.h"
#include "world/confined/jail.h"

namespace skerry::game {
namespace {

constexpr int kMostColumns = render::kMostPanoramaColumns;

/// The standard input, which is a regular file.
class InputStream : public Imf::IStream {
 public:
  InputStream() : Imf::IStream("it") {}

  bool read(char bytes[], int count) override {
    for (int got = 0; got < count;) {
      const ssize_t more = ::read(STDIN_FILENO, bytes + got, static_cast<std::size_t>(count - got));
      if (more < 0 && errno == EINTR) continue;
      if (more <= 0) throw Iex::InputExc("it is cut short");
      got += static_cast<int>(more);
    }
    return true;
  }
  std::uint64_t tellg() override {
    return static_cast<std::uint64_t>(::lseek(STDIN_FILENO, 0, SEEK_CUR));
  }
  void seekg(std::uint64_t at) override {
    if (::lseek(STDIN_FILENO, static_cast<off_t>(at), SEEK_SET) < 0)
      throw Iex::InputExc("it names a place that no file has");
  }
};

struct Box {
  Imath::Box2i box;
  std::int64_t columns() const { return std::int64_t{box.max.x} - box.min.x + 1; }
  std::int64_t rows() const { return std::int64_t{box.max.y} - box.min.y + 1; }
};

/// Channels of a part that are its colours: three, one for all, or none.
std::vector<std::string> colours_of(const Imf::Header& header) {
  const Imf::ChannelList& channels = header.channels();
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
    return {"R", "G", "B"};
  if (channels.findChannel("Y") && !channels.findChannel("RY")) return {"Y"};
  return {};
}

/// The first part with colours.
Result<int> colour_part(const Imf::MultiPartInputFile& file) {
  bool deep = false;
  for (int part = 0; part < file.parts(); ++part) {
    const Imf::Header& header = file.header(part);
    if (colours_of(header).empty()) continue;
    if (!header.hasType() || !Imf::isDeepData(header.type())) return part;
    deep = true;
  }
  if (deep) return Error{"it is deep, with several samples a texel; flatten it"};
  return Error{"it has no channels R, G and B, nor Y alone; write it as RGB"};
}

Result<void> check(const Imf::Header& header) {
  const Box display{header.displayWindow()}, data{header.dataWindow()};
  if (Imf::hasEnvmap(header) && Imf::envmap(header) == Imf::ENVMAP_CUBE)
    return Error{"it is a cube; give an equirectangular panorama"};
  for (const Box& box : {display, data})
    if (box.columns() > kMostColumns || box.rows() > kMostColumns / 2)
      return Error{fmt::format("it is {}x{}, and {}x{} is the largest; make it smaller",
                               box.columns(), box.rows(), kMostColumns, kMostColumns / 2)};
  if (Result<void> fits = render::check_panorama_shape(display.columns(), display.rows()); !fits)
    return fits;
  for (const std::string& name : colours_of(header)) {
    const Imf::Channel& channel = header.channels()[name];
    if (channel.xSampling != 1 || channel.ySampling != 1)
      return Error{"its colours are not stored at each texel; write it as RGB"};
  }
  return {};
}

/// From a file's red, green and blue to Rec. 709's, whites left where they are; none: no change.
std::optional<glm::mat3> to_rec709(const Imf::Header& header) {
  if (!Imf::hasChromaticities(header) || Imf::chromaticities(header) == Imf::Chromaticities())
    return std::nullopt;
  const Imath::M44f turn =
      Imf::RGBtoXYZ(Imf::chromaticities(header), 1.0f) * Imf::XYZtoRGB(Imf::Chromaticities(), 1.0f);
  glm::mat3 out;
  // Imath multiplies rows by matrices, glm matrices by columns.
  for (int from = 0; from < 3; ++from)
    for (int to = 0; to < 3; ++to) out[from][to] = turn[from][to];
  return out;
}

Result<render::Panorama> read() {
  InputStream stream;
  Imf::MultiPartInputFile file(stream, 0);
  const Result<int> number = colour_part(file);
  if (!number) return number.error();
  const Imf::Header& header = file.header(*number);
  if (Result<void> fits = check(header); !fits) return fits.error();
  const Box display{header.displayWindow()}, data{header.dataWindow()};
  const std::vector<std::string> colours = colours_of(header);
  const std::optional<glm::mat3> turn = to_rec709(header);

  std::vector<glm::vec3> stored(static_cast<std::size_t>(data.columns()));
  // Each row comes to the same place.
  Imf::FrameBuffer rows;
  for (std::size_t c = 0; c < colours.size(); ++c) {
    char* const first = reinterpret_cast<char*>(&stored[0][static_cast<int>(c)]);
    rows.insert(colours[c], Imf::Slice(Imf::FLOAT,
                                       first - std::ptrdiff_t{data.box.min.x} *
                                                   std::ptrdiff_t{sizeof(glm::vec3)},
                                       sizeof(glm::vec3), 0));
  }
  if (turn)
    for (int c = 0; c < 3; ++c)
      if (!glm::all(glm::lessThan(glm::abs((*turn)[c]), glm::vec3(1e3f))))
        return Error{"its chromaticities span no colours; write it as Rec. 709"};
  Imf::InputPart part(file, *number);
  part.setFrameBuffer(rows);

  const auto columns = static_cast<std::uint32_t>(display.columns());
  render::PanoramaMaker maker(columns, columns / 2);
  std::vector<glm::vec3> row(columns);
  for (int y = display.box.min.y; y <= display.box.max.y; ++y) {
    std::fill(row.begin(), row.end(), glm::vec3(0.0f));
    if (y >= data.box.min.y && y <= data.box.max.y) {
      part.readPixels(y);
      const int first = std::max(display.box.min.x, data.box.min.x),
                last = std::min(display.box.max.x, data.box.max.x);
      for (int x = first; x <= last; ++x) {
        const glm::vec3& texel = stored[static_cast<std::size_t>(x - data.box.min.x)];
        const glm::vec3 colour = colours.size() == 1 ? glm::vec3(texel.x) : texel;
        row[static_cast<std::size_t>(x - display.box.min.x)] = turn ? *turn * colour : colour;
      }
    }
    maker.add_row(row);
  }
  return maker.take();
}

Result<render::Panorama> try_read() {
  return world::guarded("OpenEXR", [] {
    Imf::setGlobalThreadCount(0);
    world::enter_jail();
    return read();
  });
}

}  // namespace
}  // namespace skerry::game

int main(int count, char** words) {
  using namespace skerry;
  const auto job = world::parse_job({words, static_cast<std::size_t>(count)});
  if (!job || job->writes()) return 2;
  world::confine(*job);
  const Result<render::Panorama> panorama = game::try_read();
  const bool sent = panorama
                        ? game::encode_panorama(*panorama, world::write_to_output)
                        : game::encode_refusal(panorama.error().message, world::write_to_output);
  return sent ? 0 : 1;
}
