// Tables by hand in the styles of machines and laboratories: each holds the same ramp and hold,
// written in its own words, units, numbers and encoding. Right values and units, or refused with
// the mend; none silently wrong.
#include <gtest/gtest.h>
#include <iconv.h>

#include "synthetic.h"

namespace hapsim::test {
namespace {

constexpr double kAir = 0.5, kDepth = 4, kLast = 12;  // [mm], [mm], [s]

// A ramp of 1 mm/s through 0.5 mm of air to 4 mm of depth, 0.25 N/mm, then a hold in which it
// relaxes.
std::vector<RampRow> truth() {
  std::vector<RampRow> rows;
  for (int i = 0; i <= 120; ++i) {
    const double t = 0.1 * i, travel = std::min(t, kAir + kDepth),
                 depth = std::max(0.0, travel - kAir);
    const double held = std::max(0.0, t - kAir - kDepth);
    rows.push_back(
        {t, travel, 0.25 * depth * (1 - 0.3 * held / (held + 2)) + 0.0004 * std::sin(i * i)});
  }
  return rows;
}

std::string encoded(const std::string& text, const char* encoding) {
  const iconv_t state = iconv_open(encoding, "UTF-8");
  std::string in = text, out(4 * text.size() + 16, '\0');
  char *from = in.data(), *to = out.data();
  std::size_t left = in.size(), room = out.size();
  EXPECT_NE(iconv(state, &from, &left, &to, &room), static_cast<std::size_t>(-1)) << encoding;
  iconv_close(state);
  out.resize(out.size() - room);
  return out;
}

struct Style {
  const char* name;
  std::string head;  // all above the rows
  // One row; the arguments are t [s], travel [mm], force [N].
  std::string (*row)(const RampRow& r);
  std::string tail = "";
  bool timed = true;
  const char* encoding = nullptr;
  int presses = 1;
};

std::string comma(std::string text) {
  return replaced(std::move(text), '.', ',');
}
std::string tsv(const RampRow& r) {
  return fmt::format("{:.2f}\t{:.4f}\t{:.5f}", r.t, r.travel, r.force);
}
std::string csv(const RampRow& r) {
  return fmt::format("{:.2f},{:.4f},{:.5f}", r.t, r.travel, r.force);
}
std::string german(const RampRow& r) {
  return comma(fmt::format("{:.2f};{:.4f};{:.5f}", r.t, r.travel, r.force));
}

const std::vector<Style>& styles() {
  static const std::vector<Style> all{
      {"Zwick in French",
       "RDG 1A;RDG 1A;RDG 1A\nTemps d'essai;Allongement;Force standard\ns;mm;N\n", german},
      {"French with accents, cp1252", "Temps (s);Déplacement (mm);Force (N)\n", german, "", true,
       "CP1252"},
      {"Spanish", "Tiempo (s)\tDesplazamiento (mm)\tFuerza (N)\n", tsv},
      {"Spanish load in kgf", "Tiempo [s],Recorrido [mm],Carga [kgf]\n",
       [](const RampRow& r) {
         return fmt::format("{:.2f},{:.4f},{:.7f}", r.t, r.travel, r.force / 9.80665);
       }},
      {"Italian", "Tempo [s];Corsa [mm];Forza [N]\n", german},
      {"Portuguese", "Tempo (s);Deslocamento (mm);Força (N)\n", german},
      {"Chinese, GB18030", "\n时间,位移,力\n(s),(mm),(N)\n",
       [](const RampRow& r) {
         return fmt::format("\"{:.4f}\",\"{:.4f}\",\"{:.4f}\"", r.t, r.travel, r.force);
       },
       "", true, "GB18030"},
      {"Chinese, load in full-width brackets", "时间（秒）,变形（毫米）,载荷（牛）\n", csv},
      {"Japanese, Shift-JIS", "時間(秒),ストローク(mm),試験力(N)\n", csv, "", true, "CP932"},
      {"Japanese, half-width letters", "時間 s,ｽﾄﾛｰｸ mm,荷重 mN\n",
       [](const RampRow& r) {
         return fmt::format("{:.2f},{:.4f},{:.3f}", r.t, r.travel, 1e3 * r.force);
       }},
      {"TA.XT", "Test ID 12\nForce\tDistance\tTime\ng\tmm\tsec\n",
       [](const RampRow& r) {
         return fmt::format("{:.4f}\t{:.4f}\t{:.2f}", r.force / 9.80665e-3, r.travel, r.t);
       }},
      {"LabVIEW .lvm",
       "LabVIEW "
       "Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\nMulti_"
       "Headings\tNo\nX_Columns\tOne\n"
       "Time_Pref\tRelative\n***End_of_Header***\t\n\t\nChannels\t2\nSamples\t121\t121\nY_Unit_"
       "Label\tmm\tN\nX_Dimension\tTime\tTime\n"
       "X0\t0.0E+0\t0.0E+0\nDelta_X\t0.1\t0.1\n***End_of_Header***\t\t\nX_"
       "Value\tDisplacement\tForce\tComment\n",
       tsv},
      {"LabVIEW .lvm without X, decimal commas",
       "LabVIEW "
       "Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tNo\n***End_of_Header***"
       "\t\nChannels\t2\n"
       "Y_Unit_Label\tMillimeter\tNewton\nX_Dimension\tTime\tTime\nX0\t0,0E+0\t0,0E+0\nDelta_X\t0,"
       "100000\t0,100000\n***End_of_Header***\n"
       "Position\tLoad\tComment\n",
       [](const RampRow& r) { return comma(fmt::format("{:.4f}\t{:.5f}", r.travel, r.force)); }},
      {"UTF-16 without its mark", "Prüfzeit [s]\tStandardweg [mm]\tStandardkraft [N]\n", tsv, "",
       true, "UTF-16LE"},
      {"UTF-16, big end first", "Time,Extension,Load\n(s),(mm),(N)\n", csv, "", true, "UTF-16BE"},
      {"thousands, decimal points", "Time (s);Travel (um);Force (mN)\n",
       [](const RampRow& r) {
         const double um = 1e3 * r.travel;
         return um < 1000
                    ? fmt::format("{:.2f};{:.1f};{:.2f}", r.t, um, 1e3 * r.force)
                    : fmt::format("{:.2f};{},{:05.1f};{:.2f}", r.t,
                                  static_cast<int>(um + 0.05) / 1000,
                                  um - 1000 * (static_cast<int>(um + 0.05) / 1000), 1e3 * r.force);
       }},
      {"thousands, decimal commas", "Zeit (s);Weg (µm);Kraft (mN)\n",
       [](const RampRow& r) {
         const double um = 1e3 * r.travel;
         const int thousand = static_cast<int>(um + 0.05) / 1000;
         return comma(fmt::format("{:.2f};", r.t)) +
                (thousand ? fmt::format("{}.{}", thousand,
                                        comma(fmt::format("{:05.1f}", um - 1000 * thousand)))
                          : comma(fmt::format("{:.1f}", um))) +
                comma(fmt::format(";{:.2f}", 1e3 * r.force));
       }},
      {"thousands by narrow spaces", "Temps (s);Course (µm);Force (mN)\n",
       [](const RampRow& r) {
         const double um = 1e3 * r.travel;
         const int thousand = static_cast<int>(um + 0.05) / 1000;
         return comma(fmt::format("{:.2f};", r.t)) +
                (thousand ? fmt::format("{}\u202f{}", thousand,
                                        comma(fmt::format("{:05.1f}", um - 1000 * thousand)))
                          : comma(fmt::format("{:.1f}", um))) +
                comma(fmt::format(";{:.2f}", 1e3 * r.force));
       }},
      {"an atomic force microscope: units glued to brackets",
       "Extend Z-Sense(nm),Extend Force(nN),Time(ms)\n",
       [](const RampRow& r) {
         return fmt::format("{:.1f},{:.2f},{:.1f}", 1e6 * r.travel, 1e9 * r.force, 1e3 * r.t);
       }},
      {"a nanoindenter's Pd", "Time (s)\tPd (µm)\tFn (mN)\n",
       [](const RampRow& r) {
         return fmt::format("{:.2f}\t{:.2f}\t{:.3f}", r.t, 1e3 * r.travel, 1e3 * r.force);
       }},
      {"units glued to words", "times,distancemm,forceN\n", csv},
      {"units after underscores", "time_ms,distance_mm,load_cN\n",
       [](const RampRow& r) {
         return fmt::format("{:.1f},{:.4f},{:.4f}", 1e3 * r.t, r.travel, 1e2 * r.force);
       }},
      {"units after a comma", "\"Time, s\",\"Extension, mm\",\"Load, N\"\n", csv},
      {"a stage's Z alone", "Time (s),Stage Z (mm),Load cell (gf)\n",
       [](const RampRow& r) {
         return fmt::format("{:.2f},{:.4f},{:.5f}", r.t, r.travel, r.force / 9.80665e-3);
       }},
      {"statistics below", "Time (s),Extension (mm),Load (N)\n", csv,
       "\nMean,2.1,0.5\nStandard deviation,0.3,0.1\nMaximum,4.5,1.0\n"},
      {"results above and below",
       "Specimen,Cube\nMaximum load (N),Extension (mm),Modulus (kPa)\n1.0,4.5,12.1\nTime "
       "(s),Extension (mm),Load (N)\n",
       csv, "Results:\nPeak load,Break,n\n1.0,2.0,3.0\n"},
      {"stamps of ROS 2", "header.stamp.sec,header.stamp.nanosec,displacement_mm,wrench.force.z\n",
       [](const RampRow& r) {
         const int sec = static_cast<int>(r.t + 1e-9);
         return fmt::format("{},{},{:.4f},{:.5f}", 1700000000 + sec,
                            static_cast<int>((r.t - sec) * 1e9 + 0.5), r.travel, r.force);
       }},
      {"rostopic echo", "%time,field.header.seq,field.depth_mm,field.force\n",
       [](const RampRow& r) {
         return fmt::format("{:.0f},{:.0f},{:.4f},{:.5f}", 1.6e18 + 1e9 * r.t, 10 * r.t, r.travel,
                            r.force);
       }},
      {"numpy's commented header", "# time_s travel_mm force_N\n",
       [](const RampRow& r) {
         return fmt::format("{:.2f} {:.4f} {:.5f}", r.t, r.travel, r.force);
       }},
      {"date and clock", "Timestamp;Position (mm);Force (N)\n",
       [](const RampRow& r) {
         return fmt::format("2024-02-29 23:59:{:05.2f};{:.4f};{:.5f}", 40 + r.t, r.travel, r.force);
       }},
      {"inches and pounds", "Time (min),Displacement (in),Force (lbf)\n",
       [](const RampRow& r) {
         return fmt::format("{:.6f},{:.7f},{:.7f}", r.t / 60, r.travel / 25.4,
                            r.force / 4.4482216152605);
       }},
      {"the gap of a rheometer", "Time [s]\tGap [mm]\tNormal force [N]\tTorque [mN m]\n",
       [](const RampRow& r) {
         return fmt::format("{:.2f}\t{:.4f}\t{:.5f}\t0.1", r.t, 20 - r.travel, r.force);
       }},
      {"two specimens side by side",
       "Time (s),Load (N),Extension (mm),Time (s),Load (N),Extension (mm)\n",
       [](const RampRow& r) {
         return fmt::format("{0:.2f},{1:.5f},{2:.4f},{0:.2f},{3:.5f},{2:.4f}", r.t, r.force,
                            r.travel, 0.5 * r.force);
       },
       "", true, nullptr, 2},
      {"numbered specimens side by side",
       "Load 1 [N];Weg 1 [mm];Zeit 1 [s];Load 2 [N];Weg 2 [mm];Zeit 2 [s];Load 3 [N];Weg 3 "
       "[mm];Zeit 3 [s]\n",
       [](const RampRow& r) {
         return comma(
             fmt::format("{1:.5f};{2:.4f};{0:.2f};{1:.5f};{2:.4f};{0:.2f};{1:.5f};{2:.4f};{0:.2f}",
                         r.t, r.force, r.travel));
       },
       "", true, nullptr, 3},
      {"a time that was lost", "Deformation (mm),Load (N)\n",
       [](const RampRow& r) { return fmt::format("{:.4f},{:.5f}", r.travel, r.force); }, "",
       false}};
  return all;
}

std::string written(const Style& style) {
  std::string text = style.head;
  for (const RampRow& r : truth()) text += style.row(r) + "\n";
  text += style.tail;
  return style.encoding ? encoded(text, style.encoding) : text;
}

TEST(ImportStyles, EachIsRight) {
  EXPECT_GE(styles().size(), 30u);
  for (const Style& style : styles()) {
    SCOPED_TRACE(style.name);
    ImportResult result;
    ASSERT_NO_THROW(
        try { result = import_text(written(style)); } catch (const Error& e) {
          ADD_FAILURE() << e.what();
          throw;
        });
    const Recording& out = result.recording;
    EXPECT_EQ(out.presses().size(), static_cast<std::size_t>(style.presses));
    double deepest = 0, highest = 0, most = 0;
    std::size_t first = 0;
    while (first < out.rows() && out.press[first] == out.press[0]) ++first;
    for (std::size_t i = 0; i < first; ++i) {
      deepest = std::max(deepest, -out.u[i].z());
      highest = std::max(highest, out.u[i].z());
      most = std::max(most, out.f[i].z());
    }
    EXPECT_NEAR(deepest + highest, 1e-3 * (kAir + kDepth), 2e-6);
    EXPECT_NEAR(deepest, 1e-3 * kDepth, 2e-4);
    EXPECT_NEAR(most, 1, 0.01);
    EXPECT_EQ(out.t.empty(), !style.timed);
    if (style.timed) {
      EXPECT_NEAR(out.t[first - 1] - out.t[0], kLast, 1e-3);
    }
    EXPECT_EQ(mentions(result.notes.warnings, "no column is a time"), !style.timed);
  }
}

void expect_refused(const std::string& text, const std::string& wrong, const std::string& mend,
                    const ImportOptions& options = {}) {
  try {
    import_text(text, options);
    ADD_FAILURE() << "not refused: " << wrong;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(mend), std::string::npos) << error.what();
  }
}

std::string table_of(const std::string& head, std::string (*row)(const RampRow&)) {
  std::string text = head + "\n";
  for (const RampRow& r : truth()) text += row(r) + "\n";
  return text;
}

TEST(ImportStyles, WhatIsNotKnownIsRefusedWithTheMend) {
  expect_refused(table_of("Time (s),Travel (mm),Force (zN)", csv), "'zN'", "--force-unit");
  expect_refused(table_of("time_s,travel_mm,force",
                          [](const RampRow& r) {
                            return fmt::format("{:.2f},{:.4f},{:.2f}", r.t, r.travel,
                                               5e3 * r.force);
                          }),
                 "the largest force is", "--force-unit mN");
  expect_refused(table_of("time_s,travel,force_N",
                          [](const RampRow& r) {
                            return fmt::format("{:.2f},{:.5f},{:.5f}", r.t, 0.05 * r.travel,
                                               r.force);
                          }),
                 "the deepest press is", "--unit mm");
  expect_refused(table_of("time_s,force_N,force_N,travel_mm",
                          [](const RampRow& r) {
                            return fmt::format("{:.2f},{:.5f},{:.5f},{:.4f}", r.t, r.force,
                                               0.5 * r.force, r.travel);
                          }),
                 "may both be the force", "--column force=NAME");
  expect_refused("Zeit;Weg (mm);Kraft (N)\n1;1,125;1,125\n2;1,250;1,250\n3;1,375;1,375\n",
                 "may stand before decimals", "--decimal comma");
  // Forces in mN, no unit named: 94 TPa under a tool of 1 um.
  ImportOptions small;
  small.tool_radius = 1e-6;
  expect_refused(table_of("time_s,travel_um,force",
                          [](const RampRow& r) {
                            return fmt::format("{:.2f},{:.4f},{:.2f}", r.t, r.travel,
                                               1e3 * r.force);
                          }),
                 "a modulus of some", "--force-unit mN", small);
  small.units.trusted = true;
  EXPECT_NO_THROW(import_text(table_of("time_s,travel_um,force",
                                       [](const RampRow& r) {
                                         return fmt::format("{:.2f},{:.4f},{:.2f}", r.t, r.travel,
                                                            1e3 * r.force);
                                       }),
                              small));
}

TEST(ImportStyles, OneOfSeveralSpecimensIsChosen) {
  const std::string text =
      table_of("Time (s),Load (N),Extension (mm),Load (N),Extension (mm)", [](const RampRow& r) {
        return fmt::format("{:.2f},{:.5f},{:.4f},{:.5f},{:.4f}", r.t, r.force, r.travel,
                           0.5 * r.force, r.travel);
      });
  ImportOptions options;
  options.specimen = "2";
  const ImportResult result = import_text(text, options);
  EXPECT_EQ(result.recording.presses().size(), 1u);
  double most = 0;
  for (const Vec3& f : result.recording.f) most = std::max(most, f.z());
  EXPECT_NEAR(most, 0.5, 0.005);
  options.specimen = "3";
  expect_refused(text, "there is no specimen '3'", "from 1 to 2", options);
}

TEST(ImportStyles, ATableTellsItsBallAndItsHeight) {
  const ImportResult ball =
      import_text(organ("site,contact_x_mm,contact_y_mm,contact_z_mm,nx,ny,nz,ContactBallCenter_x "
                        "[mm],ContactBallCenter_y [mm],"
                        "ContactBallCenter_z [mm],CurrentPos_x [mm],CurrentPos_y [mm],CurrentPos_z "
                        "[mm],fx_N,fy_N,fz_N,Fail",
                        [](int i, const Site& s, double d, const Vec3& f) {
                          return std::to_string(i) + cells(s.point) + cells(s.normal) +
                                 cells(s.point + 3.2 * s.normal) +
                                 cells(s.point + (3.2 - d) * s.normal) + cells(f) +
                                 (i == 4 ? ",1" : ",0");
                        }));
  EXPECT_EQ(*ball.recording.metadata.find("tool_radius"), "0.0032");
  EXPECT_EQ(*ball.recording.metadata.find("tool"), "sphere");
  EXPECT_EQ(ball.recording.presses().size(), 19u);
  const ImportResult gap = import_text(table_of(
      "Temps (s),Ecartement entre outils (mm),Allongement (mm),Force (N)", [](const RampRow& r) {
        return fmt::format("{:.2f},{:.4f},{:.4f},{:.5f}", r.t, 20.5 - r.travel, r.travel, r.force);
      }));
  EXPECT_NEAR(*gap.recording.metadata.number("thickness", ""), 20e-3, 2e-4);
}

TEST(ImportStyles, PalpationAlongLinesMakesNoPresses) {
  std::string text = "t_s,tip_x_mm,tip_y_mm,tip_z_mm,fx_N,fy_N,fz_N\n";
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.02 * i, x = 20 - std::abs(std::fmod(t, 20) * 2 - 20),
                 y = 2 * std::floor(t / 10);
    const bool air = std::fmod(t, 10) < 0.5;
    text +=
        fmt::format("{:.2f},{:.3f},{:.3f},{:.3f},0.01,0,{:.4f}\n", t, x, y,
                    air ? 3.0 : 0.4 * std::sin(0.3 * x), air ? 0.0 : 0.5 + 0.3 * std::sin(7 * t));
  }
  const ImportResult result = import_text(text);
  EXPECT_EQ(result.recording.presses().size(), 1u);
  EXPECT_EQ(*result.recording.metadata.find("motion"), "sliding");
  EXPECT_GT(result.touched.size(), 50u);
  EXPECT_TRUE(mentions(result.notes.warnings, "slides over the surface"));
}

}  // namespace
}  // namespace hapsim::test
