#include "report/overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "base/median.h"
#include "report/assets.h"
#include "report/html.h"
#include "report/page.h"

namespace hapsim {
namespace {

// NaN when none is known.
double median_of_known(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  return values.empty() ? std::nan("") : median(std::move(values));
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "";
}

// What the recordings have in common.
struct Common {
  double rmse, ratio, held_out;  // medians
  std::string verdicts;          // "20 complete, 3 incomplete"
  int complete = 0;
};

Common common_of(const std::vector<OverviewRow>& rows) {
  std::vector<double> rmse, ratio, held_out;
  std::map<std::string, int> verdicts;
  for (const OverviewRow& row : rows) {
    rmse.push_back(row.rmse);
    ratio.push_back(row.noise > 0 ? row.rmse / row.noise : std::nan(""));
    held_out.push_back(row.held_out);
    if (!row.verdict.empty()) ++verdicts[row.verdict];
  }
  Common c{median_of_known(rmse), median_of_known(ratio), median_of_known(held_out), "", 0};
  for (const auto& [verdict, count] : verdicts)
    c.verdicts += fmt::format("{}{} {}", c.verdicts.empty() ? "" : ", ", count, verdict);
  if (verdicts.count("complete") != 0) c.complete = verdicts["complete"];
  return c;
}

// The rows by the effects that they ask for, in the order in which these first appear; nothing when
// all ask for the same.
std::vector<std::pair<std::string, std::vector<OverviewRow>>> by_effects(const Overview& o) {
  std::vector<std::pair<std::string, std::vector<OverviewRow>>> groups;
  for (const OverviewRow& row : o.rows) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& g) { return g.first == row.asked; });
    if (group == groups.end()) group = groups.insert(group, {row.asked, {}});
    group->second.push_back(row);
  }
  if (groups.size() == 1) groups.clear();
  return groups;
}

// "viscoelastic missing in 5 of 5, friction in 1", the most frequent first; empty where nothing is.
std::string missing_words(const std::vector<OverviewRow>& rows) {
  std::vector<std::string> lists;
  int diagnosed = 0;
  for (const OverviewRow& row : rows) {
    diagnosed += row.verdict.empty() ? 0 : 1;
    lists.push_back(row.missing);
  }
  const std::map<std::string, int> count = count_names(lists);
  std::vector<std::pair<std::string, int>> order(count.begin(), count.end());
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string words;
  for (const auto& [name, times] : order)
    words += words.empty() ? fmt::format("{} missing in {} of {}", name, times, diagnosed)
                           : fmt::format(", {} in {}", name, times);
  return words;
}

Report header_of(const Overview& o) {
  const Common c = common_of(o.rows);
  Report report;
  report.title = o.title;
  report.verdict = o.verdict;
  report.good = o.failures.empty() && o.not_run.empty();
  report.provenance = o.provenance;
  report.numbers = {{"recordings done", std::to_string(o.rows.size()),
                     fmt::format("{} failed, {} not run", o.failures.size(), o.not_run.size())}};
  const auto add = [&](const char* label, double value, const char* unit, const char* note) {
    if (std::isfinite(value)) report.numbers.push_back({label, number(value) + unit, note});
  };
  add("median error", c.rmse, " N", "rmse of the fit, measured components pooled");
  add("median error over noise", c.ratio, " ×", "1 × when nothing but noise is left");
  add("median error, unseen", c.held_out, " N", "on positions left out of the fit");
  if (!c.verdicts.empty())
    report.numbers.push_back({"models complete", std::to_string(c.complete), c.verdicts});
  if (const std::string missing = missing_words(o.rows); !missing.empty())
    report.sentences.push_back(missing + ".");
  return report;
}

std::string cell(const std::string& text, bool is_number) {
  return fmt::format("<td{}>{}</td>", is_number ? " class='n'" : "", escape_html(text));
}

std::string page_groups(const Overview& o) {
  const auto groups = by_effects(o);
  if (groups.empty()) return "";
  std::string out =
      "<section><h2>By the effects asked for</h2><div class='scroll' "
      "tabindex='0'><table><thead><tr>"
      "<th>effects</th><th class='n'>recordings</th><th class='n'>median error [N]</th>"
      "<th class='n'>over noise</th><th class='n'>unseen [N]</th><th>models</th></tr></thead>"
      "<tbody>\n";
  for (const auto& [asked, rows] : groups) {
    const Common c = common_of(rows);
    out += "<tr>" + cell(asked, false) + cell(std::to_string(rows.size()), true) +
           cell(number(c.rmse), true) + cell(number(c.ratio), true) +
           cell(number(c.held_out), true) + cell(c.verdicts, false) + "</tr>\n";
  }
  return out + "</tbody></table></div></section>\n";
}

std::string page_rows(const Overview& o) {
  if (o.rows.empty()) return "";
  std::vector<const OverviewRow*> order;
  for (const OverviewRow& row : o.rows) order.push_back(&row);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto* a, const auto* b) { return a->rmse > b->rmse; });
  std::string out =
      "<section><h2>Recordings, largest error first</h2><p class='picker'><label for='filter'>only "
      "rows with</label><input id='filter' placeholder='incomplete, friction, a name'><span "
      "id='count'></span></p><div class='scroll' tabindex='0'>"
      "<table class='sortable'><thead><tr><th>recording</th><th class='n'>rmse [N]</th>"
      "<th class='n'>over noise</th><th class='n'>unseen [N]</th><th class='n'>E [Pa]</th>"
      "<th class='n'>nu</th><th>effects</th><th>verdict</th><th>missing</th></tr></thead><tbody>\n";
  for (const OverviewRow* row : order) {
    const std::string name = escape_html(row->name);
    out += row->link.empty()
               ? "<tr><td>" + name + "</td>"
               : fmt::format("<tr><td><a href='{}'>{}</a></td>", escape_html(row->link), name);
    out += cell(number(row->rmse), true) +
           cell(row->noise > 0 ? number(row->rmse / row->noise) : "", true) +
           cell(number(row->held_out), true) + cell(row->modulus, true) + cell(row->nu, true) +
           cell(row->effects, false);
    out += fmt::format("<td><span class='tag {0}'>{0}</span></td>", escape_html(row->verdict)) +
           cell(row->missing, false) + "</tr>\n";
  }
  return out + "</tbody></table></div></section>\n";
}

std::string page_failures(const Overview& o) {
  std::string out;
  if (!o.failures.empty()) {
    out +=
        "<section><h2>Failed</h2><p>The commands repeat the failures, in the folder where the "
        "batch was started and with hapsim's tools on the PATH.</p>\n";
    for (const OverviewFailure& f : o.failures) {
      out += fmt::format("<div class='long'><b>{}</b><br>{}", escape_html(f.name),
                         escape_html(f.message));
      if (!f.command.empty()) out += "<pre>" + escape_html(f.command) + "</pre>";
      out += "</div>\n";
    }
    out += "</section>\n";
  }
  if (!o.not_run.empty()) {
    out +=
        "<section><h2>Not run</h2><p>The batch was stopped before these, or what they are made of "
        "has changed; run it again.</p><ul>";
    for (const std::string& name : o.not_run) out += "<li>" + escape_html(name) + "</li>";
    out += "</ul></section>\n";
  }
  return out;
}

}  // namespace

std::map<std::string, int> count_names(const std::vector<std::string>& lists) {
  std::map<std::string, int> count;
  for (const std::string& list : lists) {
    std::istringstream words(list);
    const std::set<std::string> names{std::istream_iterator<std::string>(words), {}};
    for (const std::string& name : names) ++count[name];
  }
  return count;
}

std::vector<std::string> overview_lines(const Overview& overview) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& of, const std::vector<OverviewRow>& rows) {
    const Common c = common_of(rows);
    if (!std::isfinite(c.rmse)) return;
    lines.push_back(fmt::format(
        "{}median error {} N{}{}", of, number(c.rmse),
        std::isfinite(c.ratio) ? fmt::format(", {} times the noise", number(c.ratio)) : "",
        c.verdicts.empty() ? "" : "; models: " + c.verdicts));
  };
  add("", overview.rows);
  if (const std::string missing = missing_words(overview.rows); !missing.empty())
    lines.push_back(missing);
  for (const auto& [asked, rows] : by_effects(overview))
    add(fmt::format("{} ({}): ", asked, rows.size()), rows);
  return lines;
}

void write_overview(std::ostream& out, const Overview& overview) {
  const Report header = header_of(overview);
  write_head(out, header.title);
  out << page_header(header) << page_numbers(header) << page_failures(overview)
      << page_groups(overview) << page_rows(overview) << page_provenance(header)
      << "</main>\n<script>\n"
      << assets::kTable << "</script>\n</body></html>\n";
}

}  // namespace hapsim
