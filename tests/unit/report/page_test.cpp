#include <gtest/gtest.h>

#include <sstream>

#include "report/figures.h"

namespace hapsim {
namespace {

Report full_report(const std::string& word) {
  Report r;
  r.title = r.verdict = word;
  r.next = word;
  r.numbers = {{word, word, word}};
  r.sentences = {word};
  r.history = {word, {word, "rmse"}, {{word, "0.1"}, {word, "0.05"}}, {}};
  r.versions = {{word, 0.1, 0.2, 0.01}, {word, 0.05, 0.1, 0.01}};
  r.diagnoses = {{word, {{word, word, word, {{word, word}}, {{word, word}}, word}}}};
  r.body.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  r.body.faces = {{0, 1, 2}};
  r.body.distance = {0, 1, 2};
  r.body.positions = {{0, 0, 0}};
  r.body.layers = {{.name = word,
                    .title = word,
                    .note = word,
                    .mark = 0.5,
                    .mark_name = word,
                    .value = {0, 1, 2},
                    .at_position = {1},
                    .at_position_text = {word}}};
  r.body.layers.push_back(r.body.layers.front());
  r.parameters = {word, {word}, {{word}}, {}};
  r.curves = {word};
  r.presses = {
      {1, 0, word, 0.1, {0, 0, 1}, {0, 1}, {{0, 0, 0}, {0, 0, 1}}, {{{0, 0, 0}, {0, 0, 1}}}}};
  r.time_label = word;
  r.residuals = {{word, {0, 1}, {0, 1}, {0.5}, {0.5}, {0.1}}};
  r.tables = {{word, {word, "n"}, {{word, "1"}}, {0.5}}, {word, {word, "n"}, {{word, "1"}}, {}}};
  r.provenance = {{word, word}};
  return r;
}

std::string page(const Report& report) {
  std::ostringstream out;
  write_report(out, report);
  return out.str();
}

TEST(Page, NoWordFromAFileBecomesMarkup) {
  const std::string text = page(full_report("</script><img src=x onerror=alert(1)>'\"&"));
  EXPECT_EQ(text.find("<img"), std::string::npos);
  EXPECT_NE(text.find("&lt;img"), std::string::npos);
}

TEST(Figures, AreFilesOfTheirOwn) {
  const auto figures = report_figures(full_report("</text><script>"));
  std::string names;
  for (const auto& [name, text] : figures) {
    names += name + " ";
    EXPECT_EQ(text.find("<?xml"), 0u) << name;
    EXPECT_NE(text.find("xmlns='http://www.w3.org/2000/svg'"), std::string::npos) << name;
    EXPECT_EQ(text.find("<script>"), std::string::npos) << name;
  }
  EXPECT_EQ(names, "versions.svg residual-1.svg press-1.svg ");
}

TEST(Page, NeedsNoNetwork) {
  const std::string text = page(full_report("word"));
  for (const char* link : {"src=\"", "href=", "@import", "url(http", "https://"})
    EXPECT_EQ(text.find(link), std::string::npos) << link;
  EXPECT_EQ(text.find("http://"), text.find("http://www.w3.org/2000/svg"));  // a name, not a link
}

TEST(Page, SectionsComeInOrder) {
  const std::string text = page(full_report("word"));
  std::size_t last = 0;
  for (const char* title :
       {"Where it is decided", "The body, coloured", "Model versions and their errors",
        "Which physical effect is missing", "Parameters of the model", "Force over time",
        "Residual along", "Where the error is", "How to read", "Where this comes"}) {
    const std::size_t at = text.find(std::string("<h2>") + title);
    ASSERT_NE(at, std::string::npos) << title;
    EXPECT_GT(at, last);
    last = at;
  }
}

// The story: what each version adds, by its error on unseen data, and what comes next.
TEST(Page, BeginsWithTheVersionsAndTheNextStep) {
  Report r = full_report("word");
  r.versions = {{"elastic", 0.08, 0.0796, 0.01},
                {"elastic+sensor-drift", 0.04, 0.0395, 0.01},
                {"elastic+sensor-drift+viscoelastic", 0.01, 0.0102, 0.01}};
  r.next = "hs-identify a.csv --add <b>";
  const std::string text = page(r);
  const std::string strip = text.substr(text.find("<ol class='strip'"));
  EXPECT_NE(strip.find("<li><span>elastic</span><b>0.0796 N</b>"), std::string::npos);
  EXPECT_NE(strip.find("<li><span>+ sensor-drift</span><b>0.0395 N</b>"), std::string::npos);
  EXPECT_NE(strip.find("<li class='good'><span>+ viscoelastic</span><b>0.0102 N</b>"),
            std::string::npos);
  EXPECT_NE(
      strip.find("<code id='next'>hs-identify a.csv --add &lt;b&gt;</code><button id='copy'>"),
      std::string::npos);
  r.next_is_command = false;
  EXPECT_EQ(page(r).find("id='copy'"), std::string::npos);
}

TEST(Page, EveryPlotAndControlHasAName) {
  const std::string text = page(full_report("word"));
  for (std::size_t at = 0; (at = text.find("<svg ", at)) != std::string::npos; ++at)
    EXPECT_NE(text.substr(at, text.find('>', at) - at).find("aria-label='"), std::string::npos)
        << text.substr(at, 120);
  EXPECT_NE(text.find("tabindex='0' role='application' aria-label='The body"), std::string::npos);
  EXPECT_EQ(text.find("<th></th>"), std::string::npos);
}

TEST(Page, LeavesOutWhatIsNotThere) {
  const std::string text = page(Report{});
  EXPECT_EQ(text.find("Model versions"), std::string::npos);
  EXPECT_EQ(text.find("<script>"), std::string::npos);
  EXPECT_NE(text.find("</html>"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
