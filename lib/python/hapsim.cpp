// The module hapsim of Python: the C interface (c/hapsim.h) with numpy's arrays in place of
// pointers, and exceptions in place of statuses. A file a bound type.
#include "c/hapsim.h"

#include <pybind11/pybind11.h>

#include "python/body.h"
#include "python/comparison.h"
#include "python/diagnosis.h"
#include "python/errors.h"
#include "python/feel.h"
#include "python/live.h"
#include "python/model.h"
#include "python/prepared.h"
#include "python/recording.h"

PYBIND11_MODULE(hapsim, m) {
  m.doc() =
      "hapsim: contact-force models of soft bodies.\n\n"
      "Bodies, recordings and models are the files of hapsim's tools; simulate, identify, "
      "compare,\n"
      "diagnose and plan are the tools hs-simulate, hs-identify, hs-compare and hs-diagnose, and\n"
      "give their numbers to the last digit. Keywords are the tools' flags, with _ for -:\n"
      "fix='nu=0.45', tool_radius=0.004 or '4mm', folds=0; what may be given several times may be\n"
      "a list. say=print tells what a tool says on standard error. All numbers are in SI units.";
  m.attr("__version__") = hs_version();
  using namespace hapsim::python;
  define_errors(m);
  define_body(m);
  define_recording(m);
  define_model(m);
  define_comparison(m);
  define_diagnosis(m);
  define_prepared(m);
  define_feel(m);
  define_live(m);
}
