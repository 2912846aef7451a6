// hs-identify --image and --lumps.
#pragma once

#include "base/error.h"
#include "cli/tool.h"
#include "experiment/experiment.h"
#include "hs-identify/flags.h"
#include "imaging/image_file.h"
#include "imaging/image_sight.h"
#include "imaging/lump_file.h"
#include "imaging/stiffness_image.h"

namespace hapsim {

inline Option image_flag() {
  return {
      .flag = flag::image,
      .value = "FILE",
      .help =
          "Stiffness imaging: writes the modulus of each tetrahedron that all presses "
          "together ask for about the fitted model, and says what is seen inside the "
          "body, where, and how deep these presses see. Beside E stand log_E_std, the standard "
          "error of its logarithm (Laplace's, with the penalty as the prior and its weight open "
          "where data left out leave it open; the model's nu is taken as it is), and resolution "
          "[m], over which distance E is an average. CSV of the centres, or by the file's name the "
          "body with these: .vtu, .ply; hs-compare --inside shows a .ply.",
      .group = "Output",
      .writes = {"csv", "ply", "vtu"}};
}

inline Option lumps_flag() {
  return {.flag = flag::lumps,
          .value = "FILE",
          .help =
              "Looks for lumps inside the body as --image does and writes them as a table: centre, "
              "depth, radius and ratio of modulus, each with the interval that holds it in 95 of "
              "100, and the chance that a body without a lump looks so. No row: none is seen; the "
              "comments '# sight: RADIUS RATIO DEPTH' say down to where one would have been.",
          .group = "Output",
          .writes = {"csv"}};
}

// The modulus of every tetrahedron as all presses ask for it; in words on standard error.
inline void write_asked_image(const Arguments& arguments, const Fit& fitted,
                              const Experiment& experiment, const TetMesh& body) {
  const Model& model = fitted.model;
  const MaterialSpec material = material_of(model);
  if (material.modulus.size() > 1 || !material.features.empty())
    fail_input("", "--image and --lumps start from a body of one modulus",
               "remove regions, layers, inclusions and anisotropy from the model (--remove)");
  ImageOptions options;
  options.threads = static_cast<int>(arguments[flag::threads]);
  Progress progress(arguments, "sensitivities", experiment.dataset.positions.size());
  options.progress = [&progress] { progress.step(); };
  const StiffnessImage image = stiffness_image(model, experiment, fitted.about, body, options);
  std::string sight;
  if (arguments.given(flag::image)) {
    Output output(arguments[flag::image]);
    const ImageValues values = image_values(image, body, material.modulus[0]);
    write_image(output.stream(), body, values, image_format(arguments[flag::image]));
    output.commit();
    sight = sight_words(image_sight(body, values, experiment.dataset.positions));
  }
  if (arguments.given(flag::lumps)) {
    Output output(arguments[flag::lumps]);
    write_lumps(output.stream(), image);
    output.commit();
  }
  for (const std::string& sentence : words_of(image)) say(arguments, "hs-identify", sentence);
  if (!sight.empty()) say(arguments, "hs-identify", sight);
}

}  // namespace hapsim
