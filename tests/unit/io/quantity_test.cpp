#include "io/quantity.h"

#include "expect_error.h"

namespace hapsim {
namespace {

std::string quantity_failure(const std::string& text) {
  return error_of([&] { parse_length(text, "--edge"); }, ExitCode::kUsage);
}

TEST(Quantity, PlainNumbersAreInSi) {
  EXPECT_EQ(parse_length("0.004", "--edge"), 0.004);
  EXPECT_EQ(parse_length(" -1e-3 ", "--edge"), -0.001);
  EXPECT_EQ(parse_quantity("3000", Quantity::kPressure, "E"), 3000);
}

// 1.1 * 1e-3 is not the number that 0.0011 is.
TEST(Quantity, WithAUnitIsTheVeryNumberInSi) {
  for (const char* text : {"4mm", "4 mm", "0.4cm", "4000um", "0.004 m", "4e0mm", "+4E+3 um"})
    EXPECT_EQ(parse_length(text, "--edge"), 0.004) << text;
  for (int i = 1; i < 2000; ++i)
    EXPECT_EQ(parse_length(std::to_string(i) + "e-1mm", ""), std::stod(std::to_string(i) + "e-4"));
  EXPECT_DOUBLE_EQ(parse_length("2in", "--edge"), 0.0508);
  EXPECT_EQ(parse_quantity("1.5min", Quantity::kTime, ""), 90);
  EXPECT_EQ(parse_quantity("20mN", Quantity::kForce, ""), 0.02);
  EXPECT_EQ(parse_quantity("3kPa", Quantity::kPressure, ""), 3000);
  EXPECT_DOUBLE_EQ(parse_quantity("180deg", Quantity::kAngle, ""), 3.14159265358979323846);
}

TEST(Quantity, SaysWhatIsWrong) {
  EXPECT_EQ(quantity_failure("wide"),
            "--edge: 'wide' is no length; write for example 0.004 or 4mm");
  EXPECT_EQ(quantity_failure(""), "--edge: '' is no length; write for example 0.004 or 4mm");
  EXPECT_EQ(quantity_failure("4ms"), "--edge: unknown unit 'ms'; use one of: m mm cm um in");
  EXPECT_EQ(quantity_failure("4 4mm"), "--edge: unknown unit '4mm'; use one of: m mm cm um in");
}

TEST(Quantity, ListsTakeTheNextUnitOfTheirKind) {
  const auto lengths = [](const std::string& text) {
    return list_in_si(text, {Quantity::kLength}, "--block");
  };
  EXPECT_EQ(lengths("120x80x40mm"), "0.12x0.08x0.04");
  EXPECT_EQ(lengths("12cm,80mm,0.04m"), "0.12,0.08,0.04");
  EXPECT_EQ(lengths("1cm,80,40 mm"), "0.01,0.08,0.04");
  EXPECT_EQ(lengths("0,0,-5mm"), "0,0,-0.005");
  EXPECT_EQ(lengths("5mm"), "0.005");
  EXPECT_EQ(list_in_si("50ms:1s", {Quantity::kTime}, ""), "0.05:1");
  EXPECT_EQ(
      list_in_si("1,2,3mm,0.5,0,1",
                 {Quantity::kLength, Quantity::kLength, Quantity::kLength, Quantity::kAngle}, ""),
      "0.001,0.002,0.003,0.5,0,1");
}

TEST(Quantity, ListsWithoutUnitsStayAsTheyAre) {
  for (const char* text : {"0.120,0.0800,4e-2", "120x80x40", "auto", "1,,2mm", "", "a:b"})
    EXPECT_EQ(list_in_si(text, {Quantity::kLength}, ""), text);
}

TEST(Quantity, OfAFileIsBadInput) {
  EXPECT_EQ(error_of([] { parse_length_at("d.csv:3", "thin", "tool"); }, ExitCode::kBadInput),
            "d.csv:3: tool: 'thin' is no length; write for example 0.004 or 4mm");
}

}  // namespace
}  // namespace hapsim
