#include "report/junit.h"

#include <gtest/gtest.h>

#include <sstream>

#include "report/overview.h"

namespace hapsim {
namespace {

TEST(Junit, CountsAndEscapes) {
  std::ostringstream out;
  write_junit(
      out, "hs-x",
      {{"good", "", ""}, {"b<a>d", "E \"x\" & y", "first\nsecond"}, {"open", "", "", true}});
  const std::string xml = out.str();
  EXPECT_NE(xml.find("tests=\"3\" failures=\"1\" errors=\"0\" skipped=\"1\""), std::string::npos);
  EXPECT_NE(xml.find("<testcase classname=\"hs-x\" name=\"good\"/>"), std::string::npos);
  EXPECT_NE(xml.find("name=\"b&lt;a&gt;d\"><failure message=\"E &quot;x&quot; &amp; y\">first\n"
                     "second</failure>"),
            std::string::npos);
  EXPECT_NE(xml.find("<skipped/>"), std::string::npos);
}

TEST(Overview, LargestErrorFirstAndTextIsText) {
  Overview page;
  page.title = "t";
  page.rows = {{"small", "", "elastic", "complete"},
               {"<large>", "r/a.html", "elastic", "incomplete"}};
  page.rows[0].rmse = 0.1;
  page.rows[1].rmse = 0.3;
  page.failures = {{"bad", "m.csv:3: <script>", "hs-identify 'a b'"}};
  std::ostringstream out;
  write_overview(out, page);
  const std::string html = out.str();
  EXPECT_LT(html.find("&lt;large&gt;"), html.find(">small<"));
  EXPECT_NE(html.find("href='r/a.html'"), std::string::npos);
  EXPECT_NE(html.find("m.csv:3: &lt;script&gt;"), std::string::npos);
  EXPECT_NE(html.find("hs-identify &#39;a b&#39;"), std::string::npos);
  EXPECT_NE(html.find("1 complete, 1 incomplete"), std::string::npos);
  EXPECT_NE(html.find("</html>"), std::string::npos);
}

TEST(Overview, EachKindOfModelHasItsOwnMedian) {
  Overview page;
  page.rows = {{"a", "", "elastic", "incomplete", "", "elastic"},
               {"a2", "", "elastic+tip", "complete", "", "auto"},
               {"b", "", "elastic", "incomplete", "", "elastic"}};
  page.rows[0].rmse = 0.3;
  page.rows[1].rmse = 0.1;
  page.rows[2].rmse = 0.5;
  const std::vector<std::string> expected{"median error 0.3 N; models: 1 complete, 2 incomplete",
                                          "elastic (2): median error 0.4 N; models: 2 incomplete",
                                          "auto (1): median error 0.1 N; models: 1 complete"};
  EXPECT_EQ(overview_lines(page), expected);
  page.rows.erase(page.rows.begin() + 1);
  EXPECT_EQ(overview_lines(page).size(), 1U);
  EXPECT_TRUE(overview_lines({}).empty());
  const std::map<std::string, int> twice{{"friction", 1}, {"viscoelastic", 2}};
  EXPECT_EQ(count_names({"viscoelastic friction viscoelastic", "viscoelastic", ""}), twice);
}

TEST(Overview, CountsWhatIsMissing) {
  Overview page;
  page.rows = {{"a", "", "elastic", "incomplete", "viscoelastic friction"},
               {"b", "", "elastic", "incomplete", "viscoelastic"},
               {"c", "", "elastic", "complete", ""},
               {"d", "", "elastic", "", ""}};
  const std::vector<std::string> lines = overview_lines(page);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.front(), "viscoelastic missing in 2 of 3, friction in 1");
  std::ostringstream out;
  write_overview(out, page);
  EXPECT_NE(out.str().find("viscoelastic missing in 2 of 3, friction in 1."), std::string::npos);
  EXPECT_NE(out.str().find("id='filter'"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
