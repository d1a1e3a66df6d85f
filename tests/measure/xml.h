#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace skerry::measure {

/// Why `text` is no well-formed XML document; empty: it is one. Knows elements, attributes, the
/// entities of XML, references by number and a doctype; no comments, no processing instructions.
inline std::string xml_fault(std::string_view text) {
  const auto is_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == ':' || c == '_';
  };
  const auto bad_reference = [](std::string_view at) {
    for (const std::string_view known : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"})
      if (at.starts_with(known)) return false;
    return true;
  };
  std::vector<std::string> open;
  bool had_root = false;
  std::size_t i = text.starts_with("<!DOCTYPE html>") ? 15 : 0;
  const auto fault = [&](const std::string& what) {
    return what + " at " + std::to_string(i) + ": " + std::string(text.substr(i, 60));
  };
  while (i < text.size()) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 && byte != '\n' && byte != '\t') return fault("control character");
    if (text[i] == '&' && bad_reference(text.substr(i))) return fault("bad reference");
    if (text[i] == '>') return fault("stray >");
    if (text[i] != '<') {
      if (open.empty() && byte != '\n') return fault("text outside the root");
      ++i;
      continue;
    }
    const bool closing = text.substr(i).starts_with("</");
    std::size_t at = i + (closing ? 2 : 1), start = at;
    while (at < text.size() && is_name(text[at])) ++at;
    const std::string name(text.substr(start, at - start));
    if (name.empty()) return fault("no name");
    if (!closing && open.empty() && had_root) return fault("second root");
    std::vector<std::string> names;
    while (at < text.size() && text[at] == ' ') {
      start = ++at;
      while (at < text.size() && is_name(text[at])) ++at;
      const std::string key(text.substr(start, at - start));
      for (const std::string& other : names)
        if (other == key) return fault("attribute twice");
      names.push_back(key);
      if (key.empty() || text.substr(at, 2) != "=\"") return fault("bad attribute");
      for (at += 2; at < text.size() && text[at] != '"'; ++at)
        if (text[at] == '<' || (text[at] == '&' && bad_reference(text.substr(at))))
          return fault("bad attribute value");
      ++at;
    }
    const bool empty = text.substr(at, 2) == "/>";
    if (!empty && text.substr(at, 1) != ">") return fault("tag not closed");
    if (closing) {
      if (open.empty() || open.back() != name || !names.empty()) return fault("wrong end tag");
      open.pop_back();
    } else if (!empty) {
      open.push_back(name);
    }
    had_root = true;
    i = at + (empty ? 2 : 1);
  }
  if (!had_root) return "no root";
  return open.empty() ? "" : "not closed: " + open.back();
}

}  // namespace skerry::measure
