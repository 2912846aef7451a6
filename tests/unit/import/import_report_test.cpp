#include "import/import_report.h"

#include <gtest/gtest.h>

#include <sstream>

#include "expect_error.h"
#include "io/csv.h"
#include "support/told.h"

namespace hapsim {
namespace {

ImportResult imported() {
  ImportResult result;
  Recording& r = result.recording;
  r.name = "raw.csv";
  for (int i = 0; i < 3; ++i) {
    r.press.push_back(i == 2 ? 2 : 1);
    r.position.emplace_back(0, 0, 0.04);
    r.u.emplace_back(0, 0, i == 0 ? 0.05 : -0.002 * i);  // the first row in the air, far above
    r.f.emplace_back(0, 0, 0.5 * i);
    r.contact.push_back(i == 0 ? 0 : 1);
  }
  result.touched = {{Vec3(0, 0, 0.04), Vec3::Zero()}, {Vec3(0, 0, 0.04), Vec3::Zero()}};
  result.notes.facts = {"a fact"};
  result.notes.warnings = {"a warning"};
  return result;
}

TEST(ImportReport, TellsPlacesAndTheDepthInContact) {
  const Summary summary = import_summary(imported());
  EXPECT_EQ(test::told(summary),
            "? raw.csv: 2 presses at 1 position 3 samples SIZE depth up to 4 mm, force up to 1 N; "
            "1 sample "
            "in the air, quasi-static READ a fact WARNING: a warning WARNING: the tool's radius is "
            "unknown, and the other tools need it: --tool-radius");
  ImportResult known = imported();
  known.recording.metadata.set("tool_radius", "0.004");
  EXPECT_EQ(import_summary(known).notes.size(), 1u);
}

TEST(ImportReport, ScansHaveNormalsWhereTheyAreKnown) {
  const auto header = [](const ImportResult& result) {
    std::ostringstream out;
    write_scan(out, result);
    Input input = Input::from_bytes(out.str(), "scan.csv");
    return read_csv(input).header;
  };
  ImportResult result = imported();
  EXPECT_EQ(header(result), (std::vector<std::string>{"x", "y", "z"}));
  for (TouchedPoint& p : result.touched) p.normal = Vec3::UnitZ();
  EXPECT_EQ(header(result), (std::vector<std::string>{"x", "y", "z", "nx", "ny", "nz"}));
}

TEST(ImportReport, ABlockIsPressedOnItsTop) {
  const Vec3 block(0.1, 0.1, 0.04);
  EXPECT_FALSE(contact_place({}, {}));
  EXPECT_EQ(*contact_place({}, block), Vec3(0, 0, 0.04));
  EXPECT_EQ(*contact_place(Vec3(0.05, -0.05, 0.04), block), Vec3(0.05, -0.05, 0.04));
  for (const Vec3& off : {Vec3(0.051, 0, 0.04), Vec3(0, -0.051, 0.04), Vec3(0, 0, 0.039)})
    error_of([&] { contact_place(off, block); }, ExitCode::kUsage);
  EXPECT_EQ(*contact_place(Vec3(1, 2, 3), {}), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace hapsim
