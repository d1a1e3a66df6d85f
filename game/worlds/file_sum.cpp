#include "game/worlds/file_sum.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <memory>
#include <optional>
#include <system_error>

#include "game/scene_file/parse.h"

namespace skerry::game {
namespace {

std::optional<std::string> sha256_of(std::istream& file) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> sum(EVP_MD_CTX_new(),
                                                                    &EVP_MD_CTX_free);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  bool fine = sum && EVP_DigestInit_ex(sum.get(), EVP_sha256(), nullptr) == 1;
  std::array<char, 1 << 16> buffer;
  while (fine && file) {
    file.read(buffer.data(), buffer.size());
    fine = EVP_DigestUpdate(sum.get(), buffer.data(), static_cast<std::size_t>(file.gcount())) == 1;
  }
  if (!fine || !file.eof() || EVP_DigestFinal_ex(sum.get(), digest.data(), &size) != 1)
    return std::nullopt;
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

}  // namespace

Result<void> check_sum(const std::filesystem::path& path, const std::string& expected) {
  std::error_code code;
  std::ifstream file;
  // Not of a pipe, which would be waited for.
  if (std::filesystem::is_regular_file(path, code)) file.open(path, std::ios::binary);
  const std::optional<std::string> found = file.is_open() ? sha256_of(file) : std::nullopt;
  if (!found)
    return Error{fmt::format("cannot check {}: it cannot be read; check the path",
                             quote_text(path.string()))};
  if (*found == expected) return {};
  return Error{fmt::format("{} is not the file that is expected: its SHA-256 is {}; copy it again",
                           quote_text(path.string()), *found)};
}

}  // namespace skerry::game
