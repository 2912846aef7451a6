#include <fmt/format.h>

#include <sstream>

#include "base/error.h"
#include "c/handles.h"
#include "c/options.h"
#include "cli/shared_flags.h"
#include "diagnose/diagnose.h"
#include "diagnose/diagnosis_table.h"
#include "diagnose/draft_experiment.h"
#include "experiment/plausible.h"
#include "experiment/preparation_flags.h"
#include "fit/fit_words.h"
#include "io/stream.h"
#include "plan/press_plan.h"

struct hs_diagnosis {
  hapsim::Experiment experiment;
  hapsim::Diagnosis diagnosis;
  std::string json, text;
};

using namespace hapsim;

namespace {

constexpr IntegerFlag kDiagnoseFolds{"--folds"}, kFlips{"--flips"}, kDiagnoseSeed{"--seed"};

std::vector<Option> known_to_diagnose() {
  std::vector<Option> known = preparation_flags();
  known.push_back(
      {.flag = kDiagnoseFolds, .value = "N", .default_text = "6", .minimum = 2, .maximum = 1000});
  known.push_back(
      {.flag = kFlips, .value = "N", .default_text = "999", .minimum = 99, .maximum = 1000000});
  known.push_back({.flag = kDiagnoseSeed, .value = "N", .default_text = "1", .minimum = 0});
  return known;
}

DiagnosedFiles files_of(const Arguments& arguments, const hs_body& body, const hs_model& model,
                        const hs_recording& recording) {
  DiagnosedFiles files{recording.recording.name, body.name, model.model.name};
  files.flags = repeated_flags(arguments);
  if (arguments.output() != "-") files.output = arguments.output();
  return files;
}

}  // namespace

hs_status hs_diagnose(const hs_body* body, const hs_model* model, const hs_recording* recording,
                      const hs_options* options, hs_diagnosis** diagnosis) {
  return made(diagnosis, [&] {
    const Asked asked("hs-diagnose", known_to_diagnose(), options);
    const Arguments& arguments = asked.arguments();
    const auto say = asked.say();
    const auto end_if_stopped = asked.end_if_stopped();
    for (const std::string& words : doubts_of(model->model)) say(words);
    for (const std::string& words : doubts_of(model->model, std::span(&body->mesh, 1))) say(words);
    Experiment w = draft_experiment(body->mesh, body->window, model->model,
                                    as_asked(arguments, recording->recording, true, say),
                                    preparation_options(arguments));
    for (const std::string& words : left_out_words(w)) say(words);
    for (const std::string& words : known_words(model->model, w.dataset)) say(words);
    DiagnoseOptions diagnose_options;
    diagnose_options.folds = static_cast<int>(arguments[kDiagnoseFolds]);
    diagnose_options.flips = static_cast<int>(arguments[kFlips]);
    diagnose_options.seed = static_cast<std::uint64_t>(arguments[kDiagnoseSeed]);
    diagnose_options.progress = [&](const std::string&, std::size_t, std::size_t) {
      end_if_stopped();
    };
    Diagnosis d = diagnose(model->model, w, w.allowance(), diagnose_options);
    const DiagnosedFiles files = files_of(arguments, *body, *model, *recording);
    auto handle =
        std::unique_ptr<hs_diagnosis>(new hs_diagnosis{std::move(w), std::move(d), {}, {}});
    handle->json = diagnosis_json(handle->diagnosis, files);
    std::ostringstream text;
    write_diagnosis(text, handle->diagnosis, files, arguments.text(kDiagnoseSeed));
    handle->text = text.str();
    return handle;
  });
}

void hs_diagnosis_free(hs_diagnosis* diagnosis) {
  delete diagnosis;
}

const char* hs_diagnosis_json(const hs_diagnosis* diagnosis) {
  return diagnosis->json.c_str();
}

const char* hs_diagnosis_text(const hs_diagnosis* diagnosis) {
  return diagnosis->text.c_str();
}

hs_status hs_diagnosis_write(const hs_diagnosis* diagnosis, const char* path) {
  return guarded([&] {
    Output output(path);
    output.write(diagnosis->text);
    output.commit();
  });
}

hs_status hs_diagnosis_plan(const hs_diagnosis* diagnosis, size_t presses, hs_recording** motion) {
  return made(motion, [&] {
    if (presses < 1 || presses > 100)
      fail_usage(fmt::format("a plan of {} presses", presses), "give 1 to 100");
    return handle_of(
        plan_presses(diagnosis->diagnosis.rivals, diagnosis->experiment, presses).motion);
  });
}
