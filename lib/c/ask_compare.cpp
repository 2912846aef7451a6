#include "c/handles.h"
#include "compare/comparison.h"

struct hs_comparison {
  std::string json;
  hs_recording residuals;
};

using namespace hapsim;

hs_status hs_compare(const hs_recording* measured, const hs_recording* simulated,
                     hs_comparison** comparison) {
  return made(comparison, [&] {
    const Recording& m = measured->recording;
    const Recording& s = simulated->recording;
    const Comparison c = compare(m, s);
    auto handle = std::make_unique<hs_comparison>();
    handle->json = comparison_json(c, m.name, s.name);
    handle->residuals.recording = residuals_of(c, m, s);
    return handle;
  });
}

void hs_comparison_free(hs_comparison* comparison) {
  delete comparison;
}

const char* hs_comparison_json(const hs_comparison* comparison) {
  return comparison->json.c_str();
}

const hs_recording* hs_comparison_residuals(const hs_comparison* comparison) {
  return &comparison->residuals;
}
