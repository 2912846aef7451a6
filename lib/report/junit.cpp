#include "report/junit.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/html.h"

namespace hapsim {

namespace {

// With its line breaks, which escape_html() takes away.
std::string escaped_lines(const std::string& text) {
  std::string result;
  for (std::size_t from = 0, to; from <= text.size(); from = to + 1) {
    to = std::min(text.find('\n', from), text.size());
    result += (from == 0 ? "" : "\n") + escape_html(text.substr(from, to - from));
  }
  return result;
}

}  // namespace

void write_junit(std::ostream& out, const std::string& suite, const std::vector<JunitCase>& cases) {
  const auto count = [&](const auto& is) { return std::count_if(cases.begin(), cases.end(), is); };
  const std::string name = escape_html(suite);
  out << fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites>\n<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" "
      "skipped=\"{}\">\n",
      name, cases.size(), count([](const JunitCase& c) { return !c.failure.empty(); }),
      count([](const JunitCase& c) { return c.skipped; }));
  for (const JunitCase& c : cases) {
    out << fmt::format("<testcase classname=\"{}\" name=\"{}\"", name, escape_html(c.name));
    if (c.failure.empty() && !c.skipped) {
      out << "/>\n";
      continue;
    }
    if (c.skipped) out << "><skipped/>";
    if (!c.failure.empty())
      out << fmt::format("><failure message=\"{}\">{}</failure>", escape_html(c.failure),
                         escaped_lines(c.details.empty() ? c.failure : c.details));
    out << "</testcase>\n";
  }
  out << "</testsuite>\n</testsuites>\n";
}

}  // namespace hapsim
