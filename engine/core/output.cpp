#include "engine/core/output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "engine/core/draft.h"
#include "engine/core/stream_output.h"

namespace skerry {
namespace {

namespace fs = std::filesystem;

Result<void> write_into_stream(const fs::path& path, std::span<const std::byte> bytes) {
  Result<StreamOutput> stream = StreamOutput::open(path);
  if (!stream) return stream.error();
  const Result<void> written = stream->write(bytes);
  return written ? stream->close() : written;
}

Result<Draft> draft_of(const fs::path& name, std::span<const std::byte> bytes) {
  Result<Draft> draft = Draft::create(name);
  if (!draft) return draft;
  const int descriptor = ::open(draft->path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                                S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH);
  if (descriptor < 0) return output_error(errno);
  int code = write_all(descriptor, bytes);
  // A full disk may only be noticed here.
  if (::close(descriptor) != 0 && code == 0) code = errno;
  if (code != 0) return output_error(code);
  return draft;
}

Result<void> write_whole(const OutputPlace& place, std::span<const std::byte> bytes) {
  if (place.kind == OutputPlace::Kind::kStream) return write_into_stream(place.path, bytes);
  Result<Draft> draft = draft_of(place.path, bytes);
  return draft ? draft->publish() : draft.error();
}

Result<void> with_name(const fs::path& name, const Result<void>& done) {
  if (done) return done;
  return Error{fmt::format("cannot write {}: {}", quoted_path(name), done.error().message)};
}

}  // namespace

Result<void> write_file(const fs::path& name, std::span<const std::byte> bytes) {
  const Result<OutputPlace> place = find_output(name);
  return with_name(name, place ? write_whole(*place, bytes) : place.error());
}

Result<void> write_text(const fs::path& name, std::string_view text) {
  return write_file(name, std::as_bytes(std::span(text)));
}

Result<void> keep_as_old(const fs::path& name) {
  const Result<OutputPlace> place = find_output(name);
  if (!place || place->kind != OutputPlace::Kind::kFile) return {};
  const fs::path old = fs::path(place->path) += ".old";
  const Result<OutputPlace> free = find_output(old);
  if (!free) return with_name(old, free.error());
  if (free->kind != OutputPlace::Kind::kFile && free->kind != OutputPlace::Kind::kFree)
    return with_name(old, output_error(EEXIST));
  std::error_code code;
  fs::rename(place->path, free->path, code);
  return with_name(old, code ? output_error(code.value()) : Result<void>{});
}

struct Outputs::Ready {
  fs::path name;
  Draft draft;
};

Outputs::Outputs() = default;
Outputs::~Outputs() = default;

Result<void> Outputs::add(const fs::path& name, std::span<const std::byte> bytes) {
  Result<Draft> draft = draft_of(name, bytes);
  if (!draft) return with_name(name, draft.error());
  ready_.push_back({name, *std::move(draft)});
  return {};
}

Result<void> Outputs::add(const fs::path& name, std::string_view text) {
  return add(name, std::as_bytes(std::span(text)));
}

Result<void> Outputs::publish() {
  for (const bool streams : {true, false}) {
    for (Ready& one : ready_) {
      if (one.draft.is_stream() != streams) continue;
      if (const Result<void> done = one.draft.publish(); !done) return with_name(one.name, done);
    }
  }
  ready_.clear();
  return {};
}

Result<void> check_writable(const fs::path& name) {
  const Result<OutputPlace> place = find_output(name);
  if (!place) return with_name(name, place.error());
  if (place->kind == OutputPlace::Kind::kStream) {
    const bool may = ::faccessat(AT_FDCWD, place->path.c_str(), W_OK, AT_EACCESS) == 0;
    return with_name(name, may ? Result<void>{} : output_error(errno));
  }
  const Result<Draft> draft = Draft::create(place->path);
  return with_name(name, draft ? Result<void>{} : draft.error());
}

}  // namespace skerry
