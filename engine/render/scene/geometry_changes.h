#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shaders/shared/geometry.h"

namespace skerry::render {

/// The sections that came and went, so that what was drawn of them can be kept where nothing did.
class GeometryChanges {
 public:
  void note(const shared::Section& section) {
    if (recent_.size() == 2 * kKept) {
      recent_.erase(recent_.begin(), recent_.begin() + kKept);
      forgotten_ += kKept;
    }
    recent_.push_back(section);
  }
  /// Grows with every change.
  std::uint64_t version() const { return forgotten_ + recent_.size(); }
  /// What changed since a version; none if that is too long ago to be known.
  std::optional<std::span<const shared::Section>> since(std::uint64_t version) const {
    if (version < forgotten_ || version > this->version()) return std::nullopt;
    return std::span(recent_).subspan(static_cast<std::size_t>(version - forgotten_));
  }

 private:
  static constexpr std::size_t kKept = 4096;
  std::vector<shared::Section> recent_;
  std::uint64_t forgotten_ = 0;
};

}  // namespace skerry::render
