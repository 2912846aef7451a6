// hs-identify: the material and sensor parameters that explain a recording.
#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "common_options.h"
#include "diagnose/improve.h"
#include "diagnose/wording.h"
#include "effects/catalogue.h"
#include "estimate/identifiability.h"
#include "io/csv.h"
#include "linalg/blas.h"
#include "model/edit.h"
#include "model/extend.h"
#include "model/history.h"
#include "model/location_fit.h"
#include "model/plausible.h"
#include "model/stiffness_image.h"
#include "model/terms.h"

namespace hapsim {
namespace {

std::string effect_names() {
  std::string names;
  for (const Effect* e : catalogue()) names += (names.empty() ? "" : ", ") + e->card().name;
  return names;
}

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-identify";
  spec.summary = "identify a model from a recording of presses";
  spec.input = "recording CSV (press,t,x,y,z,ux,uy,uz,fx,fy,fz)";
  spec.description = {
      "Fits the free parameters of a model to a recording by bounded Gauss-Newton least squares "
      "with exact derivatives, and writes model.csv with standard errors. Starts from nothing "
      "(--effects) or from a model (--model), to which effects are added or from which they are "
      "removed. The error on data that the fit has not seen comes from refitting with whole "
      "contact positions left out in turn (whole presses, when there is only one position).",
      "Effects: " + effect_names() + "."};
  spec.options = workspace_flags();
  const std::vector<Option> own{
      {.flag = "--effects",
       .value = "LIST",
       .help =
           "Effects of a new model, separated by commas. auto: elastic, or --model, is diagnosed "
           "and what is missing added, as long as that helps on unseen presses.",
       .default_text = "elastic",
       .repeatable = true},
      {.flag = "--model",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Model to start from, instead of --effects."},
      {.flag = "--add",
       .value = "LIST",
       .help = "Effects to add; viscoelastic already there gets one more term.",
       .repeatable = true},
      {.flag = "--diagnosis",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Diagnosis from hs-diagnose: adds the effects that it calls missing, in its order."},
      {.flag = "--remove", .value = "LIST", .help = "Effects to remove.", .repeatable = true},
      {.flag = "--fix",
       .value = "LIST",
       .help = "Parameters to hold, with a value or without: nu=0.45, elastic.E, viscoelastic.",
       .repeatable = true},
      {.flag = "--free", .value = "LIST", .help = "Parameters to free again.", .repeatable = true},
      {.flag = "--terms",
       .value = "N",
       .help = "Maxwell terms of viscoelastic when it is added, 1 to 5; or auto: one more as long "
               "as both the information criterion and the error on data that the fit has not seen "
               "fall; auto:3 offers at most three.",
       .default_text = "1"},
      {.flag = "--windows",
       .value = "LIST",
       .help = "Windows of the relaxation times [s], disjoint, from short to long, one a term: "
               "0.05:1,2:30.",
       .repeatable = true},
      {.flag = "--regions",
       .value = "N",
       .help = "Number of regions when regions is added: a number, auto (what the positions' own "
               "moduli ask for) or sites (each position its own stiffness).",
       .default_text = "auto"},
      {.flag = "--folds",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Parts in which positions are held out; 0: no held-out error.",
       .default_text = "6",
       .minimum = 0,
       .maximum = 1000},
      {.flag = "--history",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "CSV of model versions and their errors to which this one is added."},
      {.flag = "--locations",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help =
           "Writes location samples (CSV): E, and nu where the presses tell it, of each contact "
           "position by itself, the model's other parameters held; input of hs-cluster."},
      {.flag = "--image",
       .kind = OptionKind::kFile,
       .value = "FILE",
       .help = "Stiffness imaging: writes the modulus at each tetrahedron's centre (CSV) that all "
               "presses together ask for about the fitted model, and says what is seen inside the "
               "body, where, and how deep these presses see."},
      {.flag = "--starts",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help =
           "Starts of each fit: the usual one and N - 1 spread evenly over the bounds; the least "
           "error wins.",
       .default_text = "1",
       .minimum = 1,
       .maximum = 1000},
      {.flag = "--robust",
       .kind = OptionKind::kChoice,
       .value = "LOSS",
       .help = "Discounts readings that lie far off: huber little by little, tukey in the end "
               "altogether.",
       .default_text = "none",
       .choices = {"none", "huber", "tukey"}},
      {.flag = "--profile",
       .kind = OptionKind::kSwitch,
       .help =
           "Tells the 95 % interval of each parameter from the profile of the likelihood, which "
           "need not be symmetric."},
      {.flag = "--seed",
       .kind = OptionKind::kInteger,
       .value = "N",
       .help = "Seed of --starts.",
       .default_text = "1",
       .minimum = 0}};
  spec.options.insert(spec.options.end(), own.begin(), own.end());
  spec.tables = {{"Model (output)",
                  {{"effect", "name in the catalogue, see hs-effects(7)"},
                   {"region", "region that the parameter belongs to, from 0"},
                   {"parameter", "name of the parameter"},
                   {"value", "in SI units"},
                   {"unit", "SI unit"},
                   {"std_error", "standard error, empty when not estimated"},
                   {"lower, upper", "bounds"},
                   {"state", "free, fixed or derived"}}},
                 {"--image",
                  {{"x, y, z", "centre of the tetrahedron [m], in the body's order"},
                   {"E", "Young's modulus there [Pa]"}}}};
  spec.examples = {
      {"hs-identify data.csv --body body.ply --effects elastic -o m0.csv", "A first model."},
      {"hs-identify data.csv --body body.ply --model m0.csv --add viscoelastic -o m1.csv",
       "Adds relaxation to it."},
      {"hs-identify data.csv --body body.ply --effects auto --history steps.csv -o m.csv",
       "Finds what is missing and adds it, until nothing is."},
      {"hs-identify data.csv --body body.ply --model m0.csv --diagnosis effects.csv -o m1.csv",
       "Adds what hs-diagnose found missing."},
      {"hs-identify data.csv --body body.ply --fix nu=0.45 --add regions --regions sites -o m.csv",
       "Gives each pressed position its own stiffness."}};
  spec.see_also = {"hs-simulate(1)", "hs-compare(1)", "hs-diagnose(1)", "hs-effects(7)"};
  return spec;
}

int regions_asked(const std::string& text) {
  if (text == "auto") return kAutomaticRegions;
  if (text == "sites") return kEverySite;
  double number = 0;
  if (!parse_number(text, number) || number < 1 || number != std::floor(number) || number > 10000)
    fail_usage("--regions " + text + " is not a number of regions", "give 2, auto or sites");
  return static_cast<int>(number);
}

struct TermsAsked {
  int count = 1;
  bool automatic = false;  // `count` is the most that is offered
  TimeWindows windows;
};

TermsAsked terms_asked(const Arguments& arguments) {
  constexpr int kMost = 5;
  TermsAsked asked;
  for (const std::string& text : arguments.list("--windows")) {
    const std::size_t colon = text.find(':');
    double low = 0, high = 0;
    if (colon == std::string::npos || !parse_number(text.substr(0, colon), low) ||
        !parse_number(text.substr(colon + 1), high) || low <= 0 || high <= low)
      fail_usage("--windows " + text + " is no window of relaxation times",
                 "give LOW:HIGH in seconds: 0.05:1,2:30");
    asked.windows.emplace_back(low, high);
  }
  const std::string text = arguments.text("--terms");
  double number = kMost;
  asked.automatic = text == "auto" || text.rfind("auto:", 0) == 0;
  const std::string count = !asked.automatic ? text : text == "auto" ? "5" : text.substr(5);
  if (!parse_number(count, number) || number < 1 || number != std::floor(number) || number > kMost)
    fail_usage("--terms " + text + " is not a number of terms",
               "give 1 to 5, auto, or auto:N for at most N");
  asked.count = static_cast<int>(number);
  if (asked.windows.empty()) return asked;
  if (arguments.given("--terms") &&
      (asked.automatic || asked.count != static_cast<int>(asked.windows.size())))
    fail_usage(fmt::format("{} windows, but --terms {}", asked.windows.size(), text),
               "leave --terms out: each window is a term");
  asked.automatic = false;
  asked.count = static_cast<int>(asked.windows.size());
  return asked;
}

struct Plan {
  Model start;                   // empty: elastic from the data
  bool automatic = false;        // what to add is found by diagnosis
  std::vector<std::string> add;  // in order
  std::vector<std::string> fix, free;
  TermsAsked terms;
  std::function<void(const std::string&)> say;  // what was chosen on the way; may be empty
};

// The effects that a diagnosis calls missing, in order of rank.
std::vector<std::string> missing_effects(const std::string& path) {
  Input input(path);
  const CsvTable table = read_csv(input);
  const int effect = table.find("effect"), verdict = table.find("verdict");
  if (effect < 0 || verdict < 0)
    fail_input(table.name, "this is no diagnosis: it has no columns effect and verdict",
               "give a file that hs-diagnose wrote");
  std::vector<std::string> missing;
  for (std::size_t row = 0; row < table.rows(); ++row)
    if (table.columns[verdict][row] == "missing") missing.push_back(table.columns[effect][row]);
  return missing;
}

Plan make_plan(const Arguments& arguments) {
  Plan plan;
  plan.terms = terms_asked(arguments);
  plan.say = [&arguments](const std::string& text) { say(arguments, "hs-identify", text); };
  plan.fix = arguments.list("--fix");
  plan.free = arguments.list("--free");
  plan.automatic = arguments.list("--effects") == std::vector<std::string>{"auto"};
  if (plan.automatic && (arguments.given("--add") || arguments.given("--diagnosis")))
    fail_usage("--effects auto finds what to add by itself", "leave --add and --diagnosis out");
  if (arguments.given("--model")) {
    if (arguments.given("--effects") && !plan.automatic)
      fail_usage("--model and --effects exclude each other", "use --model with --add");
    Input input(arguments.text("--model"));
    plan.start = read_model(input);
  } else if (!plan.automatic) {
    for (const std::string& effect : arguments.list("--effects"))
      if (effect != "elastic") plan.add.push_back(effect);
  }
  for (const std::string& effect : arguments.list("--add")) plan.add.push_back(effect);
  if (arguments.given("--diagnosis"))
    for (const std::string& effect : missing_effects(arguments.text("--diagnosis")))
      plan.add.push_back(effect);
  for (const std::string& effect : plan.add) require_effect(effect);
  for (const std::string& effect : arguments.list("--remove")) remove_effect(plan.start, effect);
  for (const std::string& what : plan.fix)
    if (!plan.start.parameters.empty()) set_state(plan.start, what, ParameterState::kFixed);
  for (const std::string& what : plan.free)
    if (!plan.start.parameters.empty()) set_state(plan.start, what, ParameterState::kFree);
  return plan;
}

std::string words_of(const TermChoice& choice, const std::string& effect) {
  std::string trials;
  for (const TermTrial& t : choice.trials)
    trials +=
        fmt::format("{}{}: error {:.4g} N{}", trials.empty() ? "" : "; ", t.terms, t.rmse,
                    std::isnan(t.held_out) ? "" : fmt::format(", unseen {:.4g} N", t.held_out));
  return fmt::format("{} term{} of {} chosen ({})", choice.terms, choice.terms == 1 ? "" : "s",
                     effect, trials);
}

// Models to fit on the chosen episodes: fitted step by step, one effect after the other.
std::vector<Model> build(const Plan& plan, const Workspace& w, const Selection& selection,
                         const FitOptions& fit_options, const ExtendOptions& extend) {
  Model model = plan.start;
  if (model.parameters.empty()) {
    model = elastic_model(w.dataset, selection, *w.body);
    require_like_columns(model, w.dataset, selection, *w.body);
    for (const std::string& what : plan.fix)
      if (what.find("nu") != std::string::npos) set_state(model, what, ParameterState::kFixed);
  }
  std::vector<Model> starts{model};
  for (std::size_t k = 0; k < plan.add.size(); ++k) {
    FitOptions quick = fit_options;
    quick.exact_regions = false;
    const Model base = fit_best(starts, w.dataset, selection, *w.body, quick).model;
    const EffectCard& card = require_effect(plan.add[k]).card();
    const bool terms = card.terms && !card.from_locations;
    ExtendOptions own = extend;
    if (terms && plan.terms.automatic) {
      const TermChoice choice = choose_terms(base, plan.add[k], plan.terms.count, w.dataset,
                                             selection, *w.body, quick, extend);
      own.terms = choice.terms;
      if (plan.say) plan.say(words_of(choice, plan.add[k]));
    }
    starts = with_effect(base, plan.add[k], w.dataset, selection, *w.body, own);
    if (terms && !plan.terms.windows.empty())
      for (Model& start : starts) set_windows(start, plan.add[k], plan.terms.windows);
  }
  for (Model& start : starts)
    for (const std::string& what : plan.fix) set_state(start, what, ParameterState::kFixed);
  return starts;
}

void report(const Arguments& arguments, const Workspace& w, const FitResult& result,
            double held_out, const std::string& by, double force_rms) {
  const auto line = [&](const std::string& text) { say(arguments, "hs-identify", text); };
  line(fmt::format(
      "{} presses at {} positions, {} samples; noise {:.3g} N ({}), force rms {:.3g} N",
      w.dataset.recording.presses().size(), w.dataset.positions.size(), w.dataset.rows(),
      w.noise.value, w.noise.measured ? "measured from the data" : "declared", force_rms));
  int shown = 0;
  for (const Parameter& p : result.model.parameters) {
    if (p.state != ParameterState::kFree || ++shown > 12) continue;
    line(fmt::format(
        "{} {}{} = {:.4g} {} ± {}", p.effect, p.name,
        p.region > 0 ? fmt::format(" (region {})", p.region) : "", p.value,
        p.unit == "1" ? "" : p.unit,
        std::isnan(p.std_error) ? "not estimated" : fmt::format("{:.2g}", p.std_error)));
  }
  if (shown > 12) line(fmt::format("... and {} more free parameters", shown - 12));
  const auto warn = [&](const std::vector<std::string>& names, const char* what) {
    constexpr std::size_t kMost = 4;
    for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i) line(names[i] + what);
    if (names.size() > kMost) line(fmt::format("... and {} more", names.size() - kMost));
  };
  warn(result.at_bound,
       " is at its bound: the data ask for more than the model can give, or cannot tell");
  warn(result.undetermined, " is not determined by these data: fix it, or press where it matters");
  if (const std::string strange = strange_modulus(result.model); !strange.empty()) line(strange);
  for (const std::string& sentence : result.blind) line(sentence);
  for (const std::string& sentence : untold_times(result.model, w.dataset)) line(sentence);
  for (const std::string& interval : result.intervals) line(interval);
  if (result.discounted > 0)
    line(fmt::format("{} of {} force components discounted as far off", result.discounted,
                     result.residuals));
  if (!enough_data(result.residuals,
                   static_cast<Eigen::Index>(result.model.free_parameters().size())))
    line("fewer than ten force components a free parameter: noise may decide their values");
  line(fmt::format("error {:.4g} N = {:.3g} % of the force's rms, {:.3g} x noise", result.rmse,
                   100 * result.rmse / force_rms, result.rmse / w.noise.value));
  if (!by.empty() && !std::isnan(held_out))
    line(fmt::format("on {} not seen by the fit {:.4g} N = {:.3g} %, {:.3g} x noise", by, held_out,
                     100 * held_out / force_rms, held_out / w.noise.value));
  if (arguments.verbose()) line("BLAS: " + blas_name());
}

// Adds what a diagnosis finds missing, step by step; each step goes into the history.
Improvement improve_step_by_step(const Arguments& arguments, const Plan& plan, const TetMesh& body,
                                 WorkspaceOptions options, const FitOptions& fit_options,
                                 Workspace& w, double force_rms) {
  options.draft = true;
  options.progress = nullptr;
  Workspace draft = make_workspace(body, w.dataset.recording, options);
  ImproveOptions improve_options;
  improve_options.fit = fit_options;
  improve_options.diagnose.folds = static_cast<int>(arguments.integer("--folds"));
  improve_options.diagnose.seed = fit_options.seed;
  improve_options.progress = [&](const std::string& what) {
    if (arguments.verbose()) say(arguments, "hs-identify", what);
  };
  Improvement improvement = improve(plan.start, w, draft, improve_options);
  for (std::size_t k = 0; k < improvement.steps.size(); ++k) {
    const ImprovementStep& step = improvement.steps[k];
    const std::string label = effects_label(step.fitted.model);
    say(arguments, "hs-identify",
        fmt::format("{}: error {:.4g} N, unseen {:.4g} N, {:.3g} x noise", label, step.fitted.rmse,
                    step.held_out, step.fitted.rmse / w.noise.value));
    // The last step is the model itself, which run() writes down.
    if (arguments.given("--history") && k + 1 < improvement.steps.size())
      add_history(
          arguments.text("--history"),
          {arguments.output() + ": " + label, label, step.fitted.rmse, step.held_out, w.noise.value,
           force_rms, static_cast<int>(step.fitted.model.free_parameters().size())});
  }
  if (!improvement.refused.empty())
    say(arguments, "hs-identify",
        improvement.refused + " was called missing but does not help on unseen presses: left out");
  else
    say(arguments, "hs-identify",
        verdict_name(improvement.last.verdict) + ": " + improvement.last.explanation);
  return improvement;
}

// The modulus of every tetrahedron as all presses ask for it; in words on standard error.
void write_image(const Arguments& arguments, const Model& model, const Workspace& w,
                 const TetMesh& body) {
  const MaterialSpec material = material_of(model);
  if (material.modulus.size() > 1 || !material.features.empty())
    fail_usage("--image starts from a body of one modulus",
               "remove regions, layers, inclusions and anisotropy from the model (--remove)");
  ImageOptions options;
  options.threads = static_cast<int>(arguments.integer("--threads"));
  Progress progress(arguments, "sensitivities", w.dataset.positions.size());
  options.progress = [&progress] { progress.step(); };
  const StiffnessImage image =
      stiffness_image(model, w.dataset, *w.body, body, w.noise.value, options);
  Output output(arguments.text("--image"));
  CsvWriter writer(output.stream(), {}, {"x", "y", "z", "E"});
  for (const auto& n : body.tets) {
    const Vec3 p = (body.nodes[n[0]] + body.nodes[n[1]] + body.nodes[n[2]] + body.nodes[n[3]]) / 4;
    writer.row({format_number(p.x()), format_number(p.y()), format_number(p.z()),
                format_number(material.modulus[0] * modulus_ratio(image, p))});
  }
  output.commit();
  for (const std::string& sentence : words_of(image)) say(arguments, "hs-identify", sentence);
}

int run(const Arguments& arguments) {
  const Plan plan = make_plan(arguments);
  ExtendOptions extend;
  extend.regions = regions_asked(arguments.text("--regions"));
  extend.terms = plan.terms.count;
  const TetMesh body = load_body(arguments);
  std::shared_ptr<Progress> progress;
  WorkspaceOptions options = workspace_options(arguments, progress);
  set_poisson_range(plan.start, options);
  if (plan.start.parameters.empty())
    for (const std::string& what : plan.fix) {
      const bool is_nu = what.rfind("nu=", 0) == 0 || what.rfind("elastic.nu=", 0) == 0;
      double nu = 0;
      if (is_nu && parse_number(what.substr(what.find('=') + 1), nu))
        options.nu_low = options.nu_high = nu;
    }
  Workspace w = make_workspace(body, load_recording(arguments, arguments.input(), true), options);
  progress.reset();
  FitOptions fit_options{w.noise.value, w.floor, true};
  fit_options.starts = static_cast<int>(arguments.integer("--starts"));
  fit_options.seed = static_cast<std::uint64_t>(arguments.integer("--seed"));
  if (arguments.text("--robust") == "huber") fit_options.robust = RobustLoss::kHuber;
  if (arguments.text("--robust") == "tukey") fit_options.robust = RobustLoss::kTukey;
  extend.noise = w.noise.value;
  extend.floor = w.floor;

  const Selection all = all_episodes(w.dataset);
  FitOptions final_options = fit_options;
  if (arguments.given("--profile") && fit_options.robust != RobustLoss::kNone)
    fail_usage("--profile and --robust exclude each other",
               "a robust loss is no likelihood: use one of them");
  final_options.profile = arguments.given("--profile");
  const double force_rms = std::sqrt(measured_forces(w.dataset, all).squaredNorm() /
                                     (3.0 * static_cast<double>(w.dataset.rows())));
  double held_out = std::nan("");
  Folds folds;
  FitResult result;
  if (plan.automatic) {
    const Improvement improvement =
        improve_step_by_step(arguments, plan, body, options, fit_options, w, force_rms);
    result = improvement.steps.back().fitted;
    held_out = improvement.steps.back().held_out;
    folds = make_folds(w.dataset, static_cast<int>(arguments.integer("--folds")));
  } else {
    const std::vector<Model> starts = build(plan, w, all, fit_options, extend);
    require_enough_data(starts.front(), w.dataset, all);
    result = fit_best(starts, w.dataset, all, *w.body, final_options);
  }
  if (!result.converged)
    fail_numerics(w.dataset.recording.name, "the fit did not converge: " + result.message,
                  "start from a simpler model, or fix a parameter");
  if (const long count = arguments.integer("--folds"); count > 1 && !plan.automatic) {
    folds = make_folds(w.dataset, static_cast<int>(count));
    FitOptions quick = fit_options;
    quick.exact_regions = false;
    // Each fold starts from the fit on all data; regions come from the training positions alone,
    // so they are built anew.
    Plan refit = plan;
    refit.start = result.model;
    refit.add.clear();
    refit.say = nullptr;
    if (refit.start.has("regions")) {
      remove_effect(refit.start, "regions");
      refit.add.push_back("regions");
    }
    held_out =
        held_out_error(
            [&](const Selection& training) { return build(refit, w, training, quick, extend); },
            w.dataset, folds, *w.body, quick)
            .rmse;
  }
  Model& model = result.model;
  model.metadata = plan.start.metadata;
  model.metadata.set("rmse", format_number(result.rmse));
  if (!std::isnan(held_out)) model.metadata.set("heldout", format_number(held_out));
  model.metadata.set("force_noise", format_number(w.noise.value));
  model.metadata.set("tool_radius", format_number(w.dataset.recording.tool_radius()));
  Output output(arguments.output());
  write_model(output.stream(), model);
  if (arguments.given("--locations")) {
    Output locations(arguments.text("--locations"));
    write_locations(locations.stream(), fit_locations(model, w.dataset, *w.body, fit_options));
    locations.commit();
  }
  if (arguments.given("--image")) write_image(arguments, model, w, body);
  output.commit();
  if (arguments.given("--history"))
    add_history(arguments.text("--history"),
                {arguments.output(), effects_label(model), result.rmse, held_out, w.noise.value,
                 force_rms, static_cast<int>(model.free_parameters().size())});
  report(arguments, w, result, held_out, folds.by, force_rms);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
