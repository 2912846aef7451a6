#include "simulate/field_rows.h"

#include <sstream>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

FieldRow deepest(const Dataset& dataset, std::size_t e) {
  const Episode& episode = dataset.episodes[e];
  FieldRow deep{static_cast<std::size_t>(episode.rows[0]), e, 0};
  for (std::size_t i = 0; i < episode.view.size(); ++i)
    if (!episode.view.in_air[i] && episode.view.u[i].norm() > episode.view.u[deep.sample].norm())
      deep.row = static_cast<std::size_t>(episode.rows[i]), deep.sample = i;
  return deep;
}

}  // namespace

std::vector<FieldRow> field_rows(const Dataset& dataset, const std::string& list) {
  std::vector<FieldRow> at(dataset.rows());
  for (std::size_t e = 0; e < dataset.episodes.size(); ++e)
    for (std::size_t i = 0; i < dataset.episodes[e].rows.size(); ++i) {
      const auto row = static_cast<std::size_t>(dataset.episodes[e].rows[i]);
      at[row] = {row, e, i};
    }
  std::vector<FieldRow> rows;
  if (list.empty())
    for (std::size_t e = 0; e < dataset.episodes.size(); ++e) rows.push_back(deepest(dataset, e));
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    double value = 0;
    if (!parse_number(word, value) || value < 1 || value > static_cast<double>(at.size()) ||
        value != static_cast<double>(static_cast<std::size_t>(value)))
      fail_usage("the motion has no row '" + word + "'",
                 "give row numbers from 1 to " + std::to_string(at.size()) + ", with commas");
    rows.push_back(at[static_cast<std::size_t>(value) - 1]);
  }
  return rows;
}

}  // namespace hapsim
