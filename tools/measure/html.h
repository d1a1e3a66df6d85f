// Pages of numbers and pictures for people. All output is well-formed XML too. What is called
// `markup` is taken as it is; every other string is text and is escaped.
#pragma once
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace skerry::measure {

/// Text as element content or attribute value: markup characters become entities, what XML forbids
/// (control characters, bytes that are no UTF-8) becomes U+FFFD.
std::string escape(std::string_view text);

/// Owns its texts, so that a value may come from a function.
struct Attribute {
  std::string name;
  std::string value;
};

/// `<name attributes>markup</name>`.
std::string element(std::string_view name, std::initializer_list<Attribute> attributes,
                    std::string_view markup);
std::string element(std::string_view name, std::string_view markup);
/// A text in an element with a class.
std::string labelled(std::string_view name, std::string_view css_class, std::string_view text);

/// A file's content as an address, "data:image/png;base64,...", for pages that need no other file.
/// Source: RFC 2397; RFC 4648, section 4. @param type as in "image/png".
std::string data_address(std::string_view type, std::string_view bytes);

/// A picture, shown with its pixels unsmoothed. @param source a relative path or a data_address.
std::string image(std::string_view source, std::string_view alternative);
/// A picture with a line of text below, that leads to `target` (the same picture, larger).
std::string figure(std::string_view source, std::string_view target, std::string_view caption);

/// A table. Cells are markup; a row's class (may be empty) selects its looks: "bad", "good",
/// "warn", "mark".
struct TableRow {
  std::vector<std::string> cells;
  std::string css_class;
};
std::string table(std::span<const std::string_view> headings, std::span<const TableRow> rows);

/// A whole page with the style that the above needs, light or dark as the reader's system is.
std::string page(std::string_view title, std::string_view body_markup);

}  // namespace skerry::measure
