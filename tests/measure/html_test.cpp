#include "tools/measure/html.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "tests/measure/xml.h"

namespace skerry::measure {
namespace {

constexpr std::string_view kHostile = "</td><script>alert(\"1\" & '2')</script>\x01\xff\xc3";

TEST(XmlFault, SeesWhatIsWrong) {
  EXPECT_EQ(xml_fault("<a b=\"c\"><d/>text &amp; more</a>\n"), "");
  for (const char* wrong :
       {"", "<a>", "<a></b>", "<a/><b/>", "<a b=c/>", "<a>&x;</a>", "<a b=\"1\" b=\"2\"/>",
        "<a b=\"<\"/>", "<a>\x01</a>", "text", "<a>></a>", "<br>"})
    EXPECT_NE(xml_fault(wrong), "") << wrong;
}

TEST(Html, EscapesMarkup) {
  EXPECT_EQ(escape("a<b>&\"c'"), "a&lt;b&gt;&amp;&quot;c&#39;");
  EXPECT_EQ(escape("line\nnext\ttab"), "line\nnext\ttab");
}

TEST(Html, KeepsUtf8AndReplacesWhatIsNot) {
  const std::string replacement = "\xef\xbf\xbd";
  EXPECT_EQ(escape("bl\xc3\xa5 \xe2\x88\x9e \xf0\x9f\x8f\x9d"),
            "bl\xc3\xa5 \xe2\x88\x9e \xf0\x9f\x8f\x9d");
  EXPECT_EQ(escape(std::string_view("\0", 1)), replacement);
  EXPECT_EQ(escape("\x1b["), replacement + "[");
  EXPECT_EQ(escape("\xff"), replacement);
  EXPECT_EQ(escape("\xc3"), replacement);                                      // cut off
  EXPECT_EQ(escape("\xc0\xaf"), replacement + replacement);                    // overlong '/'
  EXPECT_EQ(escape("\xed\xa0\x80"), replacement + replacement + replacement);  // a surrogate
}

TEST(Html, AddressesOfDataAreBase64) {
  // Of RFC 4648, section 10.
  for (const auto& [bytes, text] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}})
    EXPECT_EQ(data_address("image/png", bytes), std::string("data:image/png;base64,") + text);
  EXPECT_EQ(data_address("a/b", "\xff\xef\xbe"), "data:a/b;base64,/+++");
}

TEST(Html, PageIsWellFormedWhateverTheTextsAre) {
  const std::string_view headings[] = {"setting", kHostile};
  const TableRow rows[] = {{{escape(kHostile), labelled("b", kHostile, kHostile)}, "bad"},
                           {{"1", "2"}, ""}};
  const std::string body = element("h1", escape(kHostile)) + figure(kHostile, kHostile, kHostile) +
                           image(kHostile, kHostile) + table(headings, rows);
  const std::string html = page(kHostile, body);
  EXPECT_EQ(xml_fault(html), "");
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_NE(html.find("<tr class=\"bad\">"), std::string::npos);
}

}  // namespace
}  // namespace skerry::measure
