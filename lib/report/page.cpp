#include "report/page.h"

#include <fmt/format.h>

#include "report/assets.h"
#include "report/figures.h"
#include "report/html.h"

namespace hapsim {

std::string page_header(const Report& report) {
  std::string out =
      fmt::format("<header><h1>{}</h1><p class='verdict{}'>{}</p>", escape_html(report.title),
                  report.good ? " good" : "", escape_html(report.verdict));
  out += page_strip(report) + page_next(report);
  const std::string body = page_body(report);
  const bool plot = !report.presses.empty() && !report.curves.empty();
  if (!plot && body.empty()) return out + "</header>\n";
  out += fmt::format("<div class='first{}'>", plot && !body.empty() ? " both" : "");
  if (plot)
    out += "<section><h2>Where it is decided</h2><figure>" + deciding_plot(report).svg() +
           "<div class='note'>" + escape_html(deciding_press(report).place) +
           "</div></figure></section>\n";
  return out + body + "</div></header>\n";
}

std::string page_numbers(const Report& report) {
  if (report.numbers.empty() && report.sentences.empty()) return "";
  std::string out = "<section><div class='numbers'>";
  for (const KeyNumber& n : report.numbers)
    out += fmt::format("<div><span>{}</span><b>{}</b><small>{}</small></div>", escape_html(n.label),
                       escape_html(n.value), escape_html(n.note));
  out += "</div>";
  if (!report.sentences.empty()) {
    out += "<h2 class='plain'>What the error depends on</h2><ul class='findings'>";
    for (const std::string& s : report.sentences) out += "<li>" + escape_html(s) + "</li>";
    out += "</ul>";
  }
  return out + "</section>\n";
}

std::string page_reading(const Report&) {
  static constexpr std::pair<const char*, const char*> kTerms[]{
      {"Residual", "Measured minus simulated force, in newtons, row by row."},
      {"Typical error (rmse)",
       "Root of the mean of all squared component residuals: every row, the three components "
       "together. It is therefore comparable with the noise of one component; a perfect model is "
       "left with exactly the sensor noise."},
      {"% of the force", "The typical error divided by the same mean of the measured force."},
      {"Too stiff, too soft",
       "Within a group of rows, measured force is fitted as gain times simulated force. Too stiff "
       "by 18 % means that the simulated force is 18 % too large there. The ± is one standard "
       "error, from how much presses differ among themselves."},
      {"Along the normal",
       "Positive means out of the body: the force that pushes the tool back. A residual above zero "
       "means that the body pushed harder than the model. The normal is taken from the direction "
       "in which most presses of a position go."},
      {"Bands",
       "Mean of a group with two standard errors to each side; the band that keeps clear of "
       "zero shows structure that noise cannot make."},
      {"Sentences",
       "Told only when pure noise would produce any of them in fewer than 2 of 100 "
       "recordings. One cause can show in several groupings: what a sentence names is "
       "where the error shows, not yet the physical effect behind it."}};
  std::string out = "<section><h2>How to read this</h2><dl class='reading'>";
  for (const auto& [term, meaning] : kTerms)
    out += fmt::format("<dt>{}</dt><dd>{}</dd>", term, meaning);
  return out + "</dl></section>\n";
}

std::string page_provenance(const Report& report) {
  std::string out = "<section><h2>Where this comes from</h2><table class='provenance'><tbody>";
  for (const auto& [key, value] : report.provenance)
    out += fmt::format("<tr><th scope='row'>{}</th><td>{}</td></tr>", escape_html(key),
                       escape_html(value));
  return out + "</tbody></table></section>\n";
}

void write_head(std::ostream& out, const std::string& title) {
  out << "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
         "<meta name='viewport' content='width=device-width, initial-scale=1'>"
         "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; "
         "style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:\">"
      << "<title>" << escape_html(title) << "</title>\n<style>\n"
      << assets::kStyle << "</style></head><body><main>\n";
}

void write_report(std::ostream& out, const Report& report) {
  write_head(out, report.title);
  out << page_header(report) << page_numbers(report) << page_inside(report) << page_versions(report)
      << page_diagnosis(report) << page_parameters(report) << page_presses(report)
      << page_residuals(report) << page_learned(report) << page_slices(report)
      << page_tables(report) << page_reading(report) << page_provenance(report) << "</main>\n";
  if (!report.next.empty()) out << "<script>\n" << assets::kCopy << "</script>\n";
  if (!report.presses.empty()) out << "<script>\n" << assets::kPresses << "</script>\n";
  if (report.inside.size() > 0)
    out << inside_data(report) << "<script>\n" << assets::kInside << "</script>\n";
  if (!report.body.faces.empty()) out << "<script>\n" << assets::kBody << "</script>\n";
  out << "</body></html>\n";
}

}  // namespace hapsim
