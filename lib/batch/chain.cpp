#include "batch/chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/shell_words.h"
#include "batch/written_files.h"
#include "io/number.h"

namespace hapsim {
namespace {

using Words = std::vector<std::string>;

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

// What gives a flag its value: two words, one that joins them, or none.
Words flag_words(const Words& words, const std::string& flag) {
  for (std::size_t w = 0; w < words.size(); ++w) {
    if (words[w] == flag && w + 1 < words.size()) return {words[w], words[w + 1]};
    if (words[w].rfind(flag + "=", 0) == 0) return {words[w]};
  }
  return {};
}

// Collects the steps of one row after the other.
class Planner {
 public:
  explicit Planner(Batch& batch) : batch_(batch) {}

  void add(const ManifestRow& row) {
    row_ = &row;
    chain_.clear();
    common_writes_ = false;
    if (row.problem.empty()) {
      folder_ = "recordings/" + row.folder;
      const int data = row.raw.empty() ? -1 : add_data();
      const int body = row.block ? add_block(data) : row.body.empty() ? add_body(data) : -1;
      data_ = data < 0 ? row.data : path_of(data);
      body_ = body < 0 ? row.body : path_of(body);
      add_model(data, body);
    }
    batch_.chain.push_back(chain_);
  }

 private:
  std::string files_folder() const { return batch_.options.folder + "/" + folder_ + "/files"; }
  std::string path_of(int step) const { return batch_.options.folder + "/" + output(step); }
  const std::string& output(int step) const {
    return batch_.steps[static_cast<std::size_t>(step)].output;
  }

  // The command of a stage: its tool, `words`, the row's own flags, and the output.
  int add_step(const char* stage, const std::string& file, Words words, const Words& given,
               const std::vector<int>& made, bool threads) {
    const auto found =
        std::find_if(kBatchStages.begin(), kBatchStages.end(),
                     [&](const BatchStage& s) { return s.step == std::string(stage); });
    Words own = options_of(*row_, stage);
    const bool writes = place_written_files(own, files_folder());
    const auto is_threads = [](const std::string& word) {
      return word == "--threads" || word.rfind("--threads=", 0) == 0;
    };
    const bool said = std::any_of(own.begin(), own.end(), is_threads) ||
                      std::any_of(words.begin(), words.end(), is_threads);
    if (threads && !said) words.insert(words.end(), {"--threads", "1"});
    words.insert(words.end(), own.begin(), own.end());
    BatchStep step{stage, folder_, folder_ + "/" + file, {}, {}, false, ""};
    words.insert(words.begin(), found->tool);
    const bool report = step.name == "report";
    words.insert(words.end(),
                 {report ? "--html" : "-o", batch_.options.folder + "/" + step.output});
    if (report) words.insert(words.end(), {"-o", "/dev/null"});
    step.writes_files = writes || common_writes_;
    step.command = shell_line(words);
    for (const std::string& path : given)
      if (!path.empty()) step.given.push_back(path);
    const Words& files = option_files_of(*row_, stage);
    step.given.insert(step.given.end(), files.begin(), files.end());
    for (const int earlier : made)
      if (earlier >= 0) step.made.push_back(output(earlier));
    batch_.steps.push_back(std::move(step));
    chain_.push_back(static_cast<int>(batch_.steps.size()) - 1);
    return chain_.back();
  }

  // A table of another machine becomes data, and its block a surface.
  int add_data() {
    Words words{row_->raw};
    if (row_->tool_radius > 0)
      words.insert(words.end(), {"--tool-radius", format_number(row_->tool_radius)});
    if (row_->block) words.insert(words.end(), {"--surface", surface_of_block()});
    return add_step("data", "data.csv", words, {row_->raw}, {}, false);
  }

  std::string surface_of_block() const {
    return batch_.options.folder + "/" + folder_ + "/block.ply";
  }

  int add_block(int data) {
    return add_step("body", "body.ply", {surface_of_block()}, {}, {data}, false);
  }

  // The body of a scan, which other rows may share.
  int add_body(int data) {
    std::string key = row_->scan + "\n" + row_->scan_unit;
    for (const char* step : {"points", "surface", "body"})
      key += "\n" + shell_line(options_of(*row_, step));
    const auto [known, added] = bodies_.emplace(key, Words::size_type{0});
    if (added) {
      const std::string recordings = folder_;
      chain_.clear();
      folder_ = "bodies/" + plain_name(last_part(row_->scan) + "\n" + key);
      const int points = add_step("points", "points.ply", {row_->scan, "--unit", row_->scan_unit},
                                  {row_->scan}, {}, false);
      const int surface =
          add_step("surface", "surface.ply", {path_of(points)}, {}, {points}, false);
      add_step("body", "body.ply", {path_of(surface)}, {}, {surface}, false);
      folder_ = recordings;
      known->second = steps_of_bodies_.size();
      steps_of_bodies_.push_back(chain_);
    }
    chain_ = steps_of_bodies_[known->second];
    const int body = chain_.back();
    if (data >= 0) chain_.insert(chain_.begin(), data);
    return body;
  }

  void add_model(int data, int body) {
    const ManifestRow& row = *row_;
    Words common{data_, "--body", body_};
    if (row.tool_radius > 0)
      common.insert(common.end(), {"--tool-radius", format_number(row.tool_radius)});
    Words shared = row.common;
    common_writes_ = place_written_files(shared, files_folder());
    common.insert(common.end(), shared.begin(), shared.end());
    const auto with = [&](Words more) {
      more.insert(more.begin(), common.begin(), common.end());
      return more;
    };
    const Words recorded{row.data, row.body};
    Words given = recorded;
    given.insert(given.end(), row.common_files.begin(), row.common_files.end());
    const int model =
        add_step("model", "model.csv", with({"--effects", row.effects}), given, {data, body}, true);
    int diagnosis = -1;
    if (batch_.options.diagnosis)
      diagnosis = add_step("diagnosis", "effects.csv", with({"--model", path_of(model)}), given,
                           {data, body, model}, true);
    if (!batch_.options.report) return;
    const int forces = add_step("forces", "forces.csv", with({"--model", path_of(model)}), given,
                                {data, body, model}, true);
    Words compare{data_, "--simulated", path_of(forces), "--body", body_, "--title=" + row.name};
    if (diagnosis >= 0) compare.insert(compare.end(), {"--diagnosis", path_of(diagnosis)});
    // The forces are of the recording as it was put right.
    const Words calibration = flag_words(row.common, "--calibration");
    compare.insert(compare.end(), calibration.begin(), calibration.end());
    add_step("report", "report.html", compare, calibration.empty() ? recorded : given,
             {data, body, forces, diagnosis}, false);
  }

  Batch& batch_;
  const ManifestRow* row_ = nullptr;
  std::string folder_, data_, body_;
  bool common_writes_ = false;
  std::vector<int> chain_;
  std::map<std::string, std::size_t> bodies_;
  std::vector<std::vector<int>> steps_of_bodies_;
};

}  // namespace

Batch plan_batch(const Manifest& manifest, const BatchOptions& options) {
  Batch batch{manifest, options, {}, {}};
  Planner planner(batch);
  for (ManifestRow& row : batch.manifest.rows) {
    const std::string outside = written_outside(row);
    if (row.problem.empty() && !outside.empty() && options.writes.empty())
      row.problem = fmt::format(
          "{}:{}: the options write outside the recording's own folder: {}; name a file without "
          "folders above it, or allow hs-batch to with --writes",
          manifest.name, row.line, outside);
    planner.add(row);
  }
  return batch;
}

std::string output_of(const Batch& batch, std::size_t row, const std::string& step) {
  for (const int s : batch.chain[row])
    if (batch.steps[static_cast<std::size_t>(s)].name == step)
      return batch.options.folder + "/" + batch.steps[static_cast<std::size_t>(s)].output;
  return "";
}

}  // namespace hapsim
