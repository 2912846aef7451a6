#include "model/model_history.h"

#include <cmath>
#include <filesystem>

#include "io/csv.h"

namespace hapsim {

void add_history(const std::string& path, const HistoryRow& row) {
  const std::vector<std::string> header{"step",    "model", "effects",   "parameters", "rmse",
                                        "heldout", "noise", "force_rms", "heldout_by"};
  std::vector<std::vector<std::string>> rows;
  if (std::filesystem::exists(path)) {
    Input input(path);
    const CsvTable table = read_csv(input);
    const int model = table.find("model");
    for (std::size_t r = 0; r < table.rows(); ++r) {
      if (model >= 0 && table.columns[model][r] == row.model) continue;
      std::vector<std::string> fields;
      for (const std::string& column : header) {
        const int c = table.find(column);
        fields.push_back(c < 0 ? "" : table.columns[c][r]);
      }
      rows.push_back(fields);
    }
  }
  rows.push_back(
      {"", row.model, row.effects, std::to_string(row.parameters), format_number(row.rmse),
       std::isnan(row.held_out) ? "" : format_number(row.held_out), format_number(row.noise),
       format_number(row.force_rms), std::isnan(row.held_out) ? "" : row.held_out_by});
  Output output(path);
  CsvWriter writer(output.stream(), {}, header);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    rows[r][0] = std::to_string(r);
    writer.row(rows[r]);
  }
  output.commit();
}

}  // namespace hapsim
