// hs-identify --image.
#pragma once

#include "base/error.h"
#include "cli/tool.h"
#include "experiment/experiment.h"
#include "hs-identify/flags.h"
#include "imaging/image_file.h"
#include "imaging/stiffness_image.h"

namespace hapsim {

inline Option image_flag() {
  return {.flag = flag::image,
          .value = "FILE",
          .help =
              "Stiffness imaging: writes the modulus of each tetrahedron that all presses "
              "together ask for about the fitted model, and says what is seen inside the "
              "body, where, and how deep these presses see. CSV of the centres, or by the "
              "file's name the body with its moduli: .vtu, .ply.",
          .group = "Output",
          .writes = {"csv", "ply", "vtu"}};
}

// The modulus of every tetrahedron as all presses ask for it; in words on standard error.
inline void write_asked_image(const Arguments& arguments, const Fit& fitted,
                              const Experiment& experiment, const TetMesh& body) {
  const Model& model = fitted.model;
  const MaterialSpec material = material_of(model);
  if (material.modulus.size() > 1 || !material.features.empty())
    fail_input("", "--image starts from a body of one modulus",
               "remove regions, layers, inclusions and anisotropy from the model (--remove)");
  ImageOptions options;
  options.threads = static_cast<int>(arguments[flag::threads]);
  Progress progress(arguments, "sensitivities", experiment.dataset.positions.size());
  options.progress = [&progress] { progress.step(); };
  const StiffnessImage image = stiffness_image(model, experiment, fitted.about, body, options);
  Output output(arguments[flag::image]);
  write_image(output.stream(), body, image_moduli(image, body, material.modulus[0]),
              image_format(arguments[flag::image]));
  output.commit();
  for (const std::string& sentence : words_of(image)) say(arguments, "hs-identify", sentence);
}

}  // namespace hapsim
