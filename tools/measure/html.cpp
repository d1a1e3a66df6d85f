#include "tools/measure/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace skerry::measure {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --ink: #1c1f24; --paper: #ffffff; --soft: #f3f4f6;
  --line: #d5d9df; --faint: #5d6673; --good: #0f7b45; --bad: #b3261e; --warn: #8a5a00;
  --link: #0b5cad; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --paper: #15181c; --soft: #1f242a;
  --line: #363d46; --faint: #9aa4b1; --good: #5bd08f; --bad: #ff8a80; --warn: #f2b84b;
  --link: #7db7f5; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1.5rem 1rem 4rem; max-width: 76rem; color: var(--ink);
  background: var(--paper); font: 15px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; margin: 0 0 .5rem; }
h2 { font-size: 1.25rem; margin: 2.5rem 0 .3rem; padding-top: 1rem;
  border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
p { max-width: 60rem; margin: .4rem 0; }
a { color: var(--link); }
code { font: .88em/1.4 ui-monospace, monospace; overflow-wrap: anywhere; }
.faint { color: var(--faint); }
.good { color: var(--good); }
.bad { color: var(--bad); }
.warn { color: var(--warn); }
p.bad, p.warn, li.bad, td.bad { font-weight: 600; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: .6rem 0; font-size: .9rem; font-variant-numeric: tabular-nums; }
th, td { padding: .22rem .55rem; border-bottom: 1px solid var(--line); text-align: right;
  white-space: nowrap; }
th { color: var(--faint); font-weight: 600; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; }
tr.mark td { background: var(--soft); }
tr.bad, tr.warn, tr.good { color: inherit; }
tr.bad td:first-child { color: var(--bad); }
tr.warn td:first-child { color: var(--warn); }
tr.good td:first-child { color: var(--good); }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(11rem, 1fr));
  gap: .8rem; margin: .8rem 0; }
figure { margin: 0; }
figure img { display: block; width: 100%; image-rendering: pixelated;
  border: 1px solid var(--line); border-radius: 3px; }
figcaption { font-size: .82rem; color: var(--faint); overflow-wrap: anywhere; }
svg { max-width: 100%; height: auto; }
)";

/// Length of the UTF-8 sequence at the start of `text` that encodes a character XML allows; 0:
/// there is none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return first >= 0x20 || first == '\n' || first == '\t' ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = first & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  if (surrogate || overlong || code > 0x10ffff || code == 0xfffe || code == 0xffff) return 0;
  return length;
}

}  // namespace

std::string escape(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    switch (text.front()) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (length == 0)
          out += "\xef\xbf\xbd";
        else
          out += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return out;
}

std::string element(std::string_view name, std::initializer_list<Attribute> attributes,
                    std::string_view markup) {
  std::string out = fmt::format("<{}", name);
  for (const Attribute& attribute : attributes)
    out += fmt::format(" {}=\"{}\"", attribute.name, escape(attribute.value));
  return fmt::format("{}>{}</{}>", out, markup, name);
}

std::string element(std::string_view name, std::string_view markup) {
  return element(name, {}, markup);
}

std::string labelled(std::string_view name, std::string_view css_class, std::string_view text) {
  return element(name, {{"class", std::string(css_class)}}, escape(text));
}

std::string data_address(std::string_view type, std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out = fmt::format("data:{};base64,", type);
  out.reserve(out.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string image(std::string_view source, std::string_view alternative) {
  return fmt::format("<img src=\"{}\" alt=\"{}\"/>", escape(source), escape(alternative));
}

std::string figure(std::string_view source, std::string_view target, std::string_view caption) {
  return element("figure", element("a", {{"href", std::string(target)}}, image(source, caption)) +
                               element("figcaption", escape(caption)));
}

std::string table(std::span<const std::string_view> headings, std::span<const TableRow> rows) {
  std::string head, body;
  for (const std::string_view heading : headings) head += element("th", escape(heading));
  for (const TableRow& row : rows) {
    std::string cells;
    for (const std::string& cell : row.cells) cells += element("td", cell);
    body += row.css_class.empty() ? element("tr", cells)
                                  : element("tr", {{"class", row.css_class}}, cells);
    body += "\n";
  }
  return element("div", {{"class", "scroll"}},
                 element("table",
                         element("thead", element("tr", head)) + "\n" + element("tbody", body))) +
         "\n";
}

std::string page(std::string_view title, std::string_view body_markup) {
  std::string out = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n";
  out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";
  out += element("title", escape(title)) + "\n" + element("style", kStyle) + "\n</head>\n<body>\n";
  out += body_markup;
  out += "\n</body>\n</html>\n";
  return out;
}

}  // namespace skerry::measure
