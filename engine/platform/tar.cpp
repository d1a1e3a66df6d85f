#include "engine/platform/tar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/draft.h"
#include "engine/core/output.h"
#include "engine/platform/files.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBlock = 512;
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 28;        // of a file
constexpr std::uint64_t kMostHeaderBytes = std::uint64_t{1} << 16;  // of a pax or GNU header
constexpr std::size_t kMostName = 4096;

/// A header's block.
struct Header {
  char name[100], mode[8], owner[8], group[8], size[12], time[12], sum[8];
  char type;
  char link[100], magic[6], version[2], owner_name[32], group_name[32], major[8], minor[8];
  char prefix[155], rest[12];
};
static_assert(sizeof(Header) == kBlock);

template <std::size_t N>
std::string_view text_of(const char (&field)[N]) {
  return std::string_view(field,
                          static_cast<std::size_t>(std::find(field, field + N, '\0') - field));
}

/// None: it is no octal number.
template <std::size_t N>
std::optional<std::uint64_t> number_of(const char (&field)[N]) {
  std::string_view text = text_of(field);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.empty()) return std::nullopt;
  std::uint64_t value = 0;
  for (const char c : text) {
    if (c < '0' || c > '7') return std::nullopt;
    value = value * 8 + static_cast<std::uint64_t>(c - '0');
  }
  return value;
}

template <std::size_t N>
void set_number(char (&field)[N], std::uint64_t value) {
  const std::string text = fmt::format("{:0{}o}", value, N - 1);
  std::copy_n(text.c_str(), N, field);  // with its zero byte
}

/// Of the header's bytes, the sum's own taken as spaces.
std::uint64_t sum_of(Header header) {
  std::fill(std::begin(header.sum), std::end(header.sum), ' ');
  std::array<unsigned char, kBlock> bytes;
  std::memcpy(bytes.data(), &header, kBlock);
  return std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
}

/// What a pax header says of the file behind it.
struct PaxFacts {
  std::optional<std::string> path;
  bool other_size = false;  // than the file's own header states, as of sparse files
};

/// Of records of "LENGTH KEY=VALUE\n". None: they are damaged.
std::optional<PaxFacts> pax_facts(std::string_view records) {
  PaxFacts facts;
  while (!records.empty()) {
    const std::size_t space = records.find(' ');
    if (space == std::string_view::npos || space == 0 || space > 9) return std::nullopt;
    std::size_t length = 0;
    for (const char c : records.substr(0, space)) {
      if (c < '0' || c > '9') return std::nullopt;
      length = length * 10 + static_cast<std::size_t>(c - '0');
    }
    if (length <= space + 1 || length > records.size()) return std::nullopt;
    const std::string_view record = records.substr(space + 1, length - space - 2);
    if (record.starts_with("path=")) facts.path = std::string(record.substr(5));
    facts.other_size |= record.starts_with("size=") || record.starts_with("GNU.sparse.");
    records.remove_prefix(length);
  }
  return facts;
}

/// A name below a folder. None: it is too long, or leads elsewhere or to the folder itself.
std::optional<fs::path> inside(std::string_view name) {
  if (name.size() > kMostName || name.starts_with('/') || name.find('\0') != std::string_view::npos)
    return std::nullopt;
  fs::path path;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('/'), name.size());
    const std::string_view part = name.substr(0, end);
    if (part == "..") return std::nullopt;
    if (!part.empty() && part != ".") path /= std::string(part);
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  if (path.empty()) return std::nullopt;
  return path;
}

/// Takes an archive apart, a header at a time.
class Unpacking {
 public:
  Unpacking(const fs::path& archive, const fs::path& into)
      : archive_(archive), into_(into), in_(archive, std::ios::binary) {}

  Result<void> run() {
    if (!in_) return failed("it cannot be opened");
    for (Header header; in_.read(reinterpret_cast<char*>(&header), kBlock);) {
      if (header.name[0] == '\0' && sum_of(header) == 8 * ' ') return {};  // the end
      if (Result<void> taken = take(header); !taken) return taken;
    }
    return failed("it is cut short");
  }

 private:
  Error failed(std::string_view why) const {
    return {fmt::format("cannot read {}: {}; give a tar archive of regular files",
                        quoted_path(archive_), why)};
  }

  std::uint64_t bytes_left() {
    std::error_code code;
    const std::uintmax_t bytes = fs::file_size(archive_, code);
    const auto at = static_cast<std::uintmax_t>(in_.tellg());
    return code || at > bytes ? 0 : bytes - at;
  }

  Result<void> take(const Header& header) {
    const std::optional<std::uint64_t> size = number_of(header.size);
    if (!size || number_of(header.sum) != sum_of(header)) return failed("it is damaged, or no tar");
    if (*size > kMostBytes) return failed("it has a file of more than 256 MiB");
    const bool names = header.type == 'x' || header.type == 'L' || header.type == 'g';
    if (names && *size > kMostHeaderBytes) return failed("a header in it is longer than 64 KiB");
    if (*size > bytes_left()) return failed("it is cut short");  // before memory is taken
    std::string content(*size, '\0');
    in_.read(content.data(), static_cast<std::streamsize>(*size));
    in_.ignore(static_cast<std::streamsize>((kBlock - *size % kBlock) % kBlock));
    if (!in_) return failed("it is cut short");
    switch (header.type) {
      case 'x':
        return take_pax(content);
      case 'L':  // GNU
        next_name_ = content.substr(0, content.find('\0'));
        return {};
      case 'g':
        return {};
      case '5':
        next_name_.reset();
        return {};
      case '0':
      case '\0':
        return write(name_of(header), content);
      default:
        return failed("it holds a link or a device");
    }
  }

  Result<void> take_pax(const std::string& records) {
    std::optional<PaxFacts> facts = pax_facts(records);
    if (!facts) return failed("it is damaged");
    if (facts->other_size) return failed("it holds a sparse file, or one of more than 8 GiB");
    next_name_ = std::move(facts->path);
    return {};
  }

  std::string name_of(const Header& header) {
    if (next_name_) return *std::exchange(next_name_, std::nullopt);
    const std::string name(text_of(header.name));
    const bool ustar = std::string_view(header.magic, 6) == std::string_view("ustar\0", 6);
    if (!ustar || header.prefix[0] == '\0') return name;
    return std::string(text_of(header.prefix)) + "/" + name;
  }

  Result<void> write(const std::string& name, const std::string& content) const {
    const std::optional<fs::path> path = inside(name);
    if (!path) return failed("a name in it is too long or leads elsewhere");
    if (Result<void> made = make_dirs((into_ / *path).parent_path()); !made) return made;
    return write_text(into_ / *path, content);
  }

  const fs::path &archive_, &into_;
  std::ifstream in_;
  std::optional<std::string> next_name_;  // as a header before has said
};

/// None: the name is too long.
std::optional<Header> header_of(const std::string& name, std::uint64_t size) {
  Header header{};
  std::size_t split = 0;  // of prefix and name
  if (name.size() > sizeof header.name) {
    split = name.find('/', name.size() - sizeof header.name - 1);
    if (split == std::string::npos || split > sizeof header.prefix) return std::nullopt;
    std::copy_n(name.begin(), split, header.prefix);
    ++split;
  }
  std::copy(name.begin() + static_cast<std::ptrdiff_t>(split), name.end(), header.name);
  set_number(header.mode, 0644);
  set_number(header.owner, 0);
  set_number(header.group, 0);
  set_number(header.size, size);
  set_number(header.time, 0);
  header.type = '0';
  std::memcpy(header.magic, "ustar", 6);
  std::memcpy(header.version, "00", 2);
  const std::string sum = fmt::format("{:06o}", sum_of(header));
  std::memcpy(header.sum, sum.c_str(), 7);
  header.sum[7] = ' ';
  return header;
}

/// Regular files below a folder, as names in an archive, sorted.
Result<std::vector<std::string>> names_below(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code))
    if (at->is_regular_file(code))
      names.push_back(at->path().lexically_relative(folder).generic_string());
  if (code)
    return Error{
        fmt::format("cannot pack {}: {}; check the folder", quoted_path(folder), code.message())};
  std::ranges::sort(names);
  return names;
}

}  // namespace

Result<void> unpack_tar(const fs::path& archive, const fs::path& into) {
  return Unpacking(archive, into).run();
}

Result<void> pack_tar(const fs::path& folder, const fs::path& archive) {
  const auto failed = [&](std::string_view why) {
    return Error{fmt::format("cannot write {}: {}", quoted_path(archive), why)};
  };
  const Result<std::vector<std::string>> names = names_below(folder);
  if (!names) return names.error();
  Result<Draft> draft = Draft::create(archive);
  if (!draft) return failed(draft.error().message);
  std::ofstream out(draft->path(), std::ios::binary);
  for (const std::string& name : *names) {
    const Result<std::string> content = read_text(folder / name, kMostBytes);
    if (!content) return content.error();
    const std::optional<Header> header = header_of(name, content->size());
    if (!header) return failed(fmt::format("{} is too long a name", quoted_path(name)));
    out.write(reinterpret_cast<const char*>(&*header), kBlock);
    out.write(content->data(), static_cast<std::streamsize>(content->size()));
    const std::string fill((kBlock - content->size() % kBlock) % kBlock, '\0');
    out.write(fill.data(), static_cast<std::streamsize>(fill.size()));
  }
  out.write(std::string(2 * kBlock, '\0').data(), 2 * kBlock);
  out.close();
  if (!out) return failed("the disk may be full; make room");
  if (const Result<void> done = draft->publish(); !done) return failed(done.error().message);
  return {};
}

}  // namespace skerry::platform
