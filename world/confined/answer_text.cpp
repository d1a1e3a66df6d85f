#include "world/confined/answer_text.h"

namespace skerry::world {

std::string printable(std::string_view text) {
  std::string out(text.substr(0, kMostAnswerText));
  for (char& c : out)
    if (c < ' ' || c > '~') c = '?';
  return out;
}

}  // namespace skerry::world
