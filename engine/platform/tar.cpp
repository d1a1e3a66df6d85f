#include "engine/platform/tar.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <locale.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/draft.h"
#include "engine/core/log.h"
#include "engine/core/output.h"
#include "engine/platform/files.h"

namespace skerry::platform {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMostBytes = std::int64_t{1} << 28;  // of a file
constexpr std::size_t kMostName = 4096;

using TarReader = std::unique_ptr<archive, decltype(&archive_read_free)>;
using TarWriter = std::unique_ptr<archive, decltype(&archive_write_free)>;
using TarEntry = std::unique_ptr<archive_entry, decltype(&archive_entry_free)>;

/// Names are bytes, or UTF-8 where an archive says so, which libarchive converts to what the
/// thread's locale has; the program's own is C, which has no letters but ASCII's.
class Utf8Locale {
 public:
  Utf8Locale() : ours_(::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr)) {
    if (ours_) before_ = ::uselocale(ours_);
  }
  ~Utf8Locale() {
    if (!ours_) return;
    ::uselocale(before_);
    ::freelocale(ours_);
  }
  Utf8Locale(const Utf8Locale&) = delete;
  Utf8Locale& operator=(const Utf8Locale&) = delete;

 private:
  locale_t ours_, before_ = nullptr;
};

/// What libarchive says of the last failure.
std::string reason(archive* of) {
  const char* text = archive_error_string(of);
  return text ? one_line(text) : "out of memory";
}

/// A name below a folder. None: it is too long, or leads elsewhere or to the folder itself.
std::optional<fs::path> inside(const char* name) {
  if (!name || std::string_view(name).size() > kMostName) return std::nullopt;
  const fs::path path = fs::path(name).lexically_normal();
  if (path.is_absolute() || !path.has_filename() || path == "." || *path.begin() == "..")
    return std::nullopt;
  return path;
}

/// Takes an archive apart, an entry at a time.
class Unpacking {
 public:
  Unpacking(const fs::path& archive, const fs::path& into)
      : archive_(archive), into_(into), in_(archive_read_new(), &archive_read_free) {}

  Result<void> run() {
    std::error_code code;
    const std::uintmax_t bytes = fs::file_size(archive_, code);
    if (code) return failed(code.message());
    // Nothing compressed, so that no file holds more than the archive has.
    archive_read_support_format_tar(in_.get());
    if (archive_read_open_filename(in_.get(), archive_.c_str(), std::size_t{1} << 16) != ARCHIVE_OK)
      return failed(reason(in_.get()));
    archive_entry* entry = nullptr;
    int status = ARCHIVE_OK;
    while ((status = archive_read_next_header(in_.get(), &entry)) == ARCHIVE_OK)
      if (Result<void> taken = take(entry); !taken) return taken;
    if (status != ARCHIVE_EOF) return failed(reason(in_.get()));
    // libarchive does not ask for the blocks of zeros that end an archive.
    if (static_cast<std::uintmax_t>(archive_read_header_position(in_.get())) >= bytes)
      return failed("it is cut short");
    return {};
  }

 private:
  Error failed(std::string_view why) const {
    return {fmt::format("cannot read {}: {}; give a tar archive of regular files",
                        quoted_path(archive_), why)};
  }

  Result<void> take(archive_entry* entry) const {
    if (archive_entry_hardlink(entry)) return failed("it holds a link");
    if (archive_entry_filetype(entry) == AE_IFDIR) return {};
    if (archive_entry_filetype(entry) != AE_IFREG) return failed("it holds a link or a device");
    if (archive_entry_sparse_count(entry) > 0) return failed("it holds a sparse file");
    if (archive_entry_size(entry) > kMostBytes) return failed("it has a file of more than 256 MiB");
    const std::optional<fs::path> path = inside(archive_entry_pathname(entry));
    if (!path) return failed("a name in it is too long or leads elsewhere");
    return write(into_ / *path);
  }

  /// The content of the entry that was read last.
  Result<void> write(const fs::path& file) const {
    if (Result<void> made = make_dirs(file.parent_path()); !made) return made;
    std::ofstream out(file, std::ios::binary | std::ios::trunc);
    const void* block = nullptr;
    std::size_t bytes = 0;
    la_int64_t at = 0;
    int status = ARCHIVE_OK;
    while ((status = archive_read_data_block(in_.get(), &block, &bytes, &at)) == ARCHIVE_OK)
      out.write(static_cast<const char*>(block), static_cast<std::streamsize>(bytes));
    if (status != ARCHIVE_EOF) return failed(reason(in_.get()));
    out.close();
    if (out) return {};
    return Error{fmt::format("cannot unpack {}: {} cannot be written; the disk may be full",
                             quoted_path(archive_), quoted_path(file))};
  }

  const fs::path &archive_, &into_;
  TarReader in_;
};

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

/// Adds a file. What an entry says is its name and its size alone.
/// @return whether it was added; else the writer has the reason.
bool add_file(archive* out, const std::string& name, const std::string& content) {
  const TarEntry entry(archive_entry_new(), &archive_entry_free);
  archive_entry_set_pathname(entry.get(), name.c_str());
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  archive_entry_set_mtime(entry.get(), 0, 0);
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(content.size()));
  return archive_write_header(out, entry.get()) == ARCHIVE_OK &&
         archive_write_data(out, content.data(), content.size()) ==
             static_cast<la_ssize_t>(content.size());
}

}  // namespace

Result<void> unpack_tar(const fs::path& archive, const fs::path& into) {
  const Utf8Locale locale;
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
  const TarWriter out(archive_write_new(), &archive_write_free);
  archive_write_set_format_ustar(out.get());
  archive_write_set_bytes_in_last_block(out.get(), 1);  // no filling behind the end
  if (archive_write_open_filename(out.get(), draft->path().c_str()) != ARCHIVE_OK)
    return failed(reason(out.get()));
  for (const std::string& name : *names) {
    const Result<std::string> content = read_text(folder / name, kMostBytes);
    if (!content) return content.error();
    if (!add_file(out.get(), name, *content))
      return failed(fmt::format("{}: {}", quoted_path(name), reason(out.get())));
  }
  if (archive_write_close(out.get()) != ARCHIVE_OK) return failed(reason(out.get()));
  if (const Result<void> done = draft->publish(); !done) return failed(done.error().message);
  return {};
}

}  // namespace skerry::platform
