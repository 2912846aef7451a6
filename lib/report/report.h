// What a comparison report shows: plain data, already worded, ready to be laid out.
#pragma once

#include <array>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct KeyNumber {
  std::string label;  // "typical error"
  std::string value;  // "0.047 N"
  std::string note;   // "3.5 times the sensor noise"
};

struct ReportTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // text; escaped when written
  std::vector<double>
      bar;  // one a row: length of a bar in the last column, in shares of the largest
};

// Name and numbers of one model version.
struct ReportVersion {
  std::string name;
  double rmse = std::numeric_limits<double>::quiet_NaN();      // [N]
  double held_out = std::numeric_limits<double>::quiet_NaN();  // [N]
  double noise = std::numeric_limits<double>::quiet_NaN();     // [N]
};

struct ReportPress {
  int id = 0;
  int position = -1;  // index into ReportBody::positions, -1: none
  std::string place;
  double rmse = 0;                           // [N]
  Vec3 direction = Vec3(0, 0, 1);            // of the force, for the small plots
  std::vector<double> t;                     // [s]; without a time column the row number
  std::vector<Vec3> measured;                // [N]
  std::vector<std::vector<Vec3>> simulated;  // one a version
};

// Residual along the surface normal against one quantity.
struct ResidualPlot {
  std::string x_label;                      // "depth [mm]"
  std::vector<double> x, y;                 // decimated rows; y [N]
  std::vector<double> centre, mean, error;  // of bins; error: one standard error
};

// One quantity that the body is coloured by.
struct BodyLayer {
  enum class Scale {
    kSize,    // pale to dark, from 0
    kSigned,  // blue below 0, red above
    kFactor,  // the same of the logarithm of a factor
    kKinds    // whole numbers, a colour each
  };
  std::string name;   // of the button: "error"
  std::string title;  // of the colour bar: "error [N]"
  std::string note;   // one sentence
  Scale scale = Scale::kSize;
  double top = 1;                             // of the scale; kSigned, kFactor: from -top
  double mark = 0;                            // a value to mark on the bar; 0: none
  std::string mark_name;                      // "noise"
  bool local = true;                          // grey beyond the reach of the positions
  std::vector<double> value;                  // one a vertex; none: of ReportInside
  std::vector<double> at_position;            // one a position
  std::vector<std::string> at_position_text;  // "error 0.12 N"
};

struct ReportBody {
  std::vector<Vec3> vertices;             // [m]
  std::vector<std::array<int, 3>> faces;  // may be empty: only the positions are shown
  std::vector<double> distance;           // one a vertex: to the nearest position [m]
  double reach = 1;                       // [m]; beyond it local layers are grey
  std::vector<Vec3> positions;            // [m]
  std::vector<BodyLayer> layers;          // the first is the error, and is shown first
};

// An image of the stiffness inside the body, in cubic cells, x fastest.
struct ReportInside {
  std::array<int, 3> count{0, 0, 0};  // cells along x, y, z; 0: there is no image
  Vec3 low = Vec3::Zero();            // corner of the first cell [m]
  double cell = 1;                    // edge [m]
  std::vector<double> log_ratio;      // of the modulus over the model's; NaN outside the body
  std::vector<double> log_std;        // its standard error
  std::vector<double> resolution;     // over which distance it is an average [m]
  double top = 0;                     // z of the body's highest point [m]
  double half95 = 0;                  // of the 95 %, in standard errors
  std::size_t ratio_layer = 0, error_layer = 0;  // of ReportBody::layers
  std::vector<std::string> words;                // how finely, and how deep
  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
           static_cast<std::size_t>(count[2]);
  }
};

struct DiagnosisRow {
  std::string rank, effect, verdict;
  std::vector<std::pair<std::string, std::string>> facts;  // short cells: name, text
  std::vector<std::pair<std::string, std::string>> notes;  // long text: name, text
  std::string command;
  double p_value = std::numeric_limits<double>::quiet_NaN();
};

// A curve with its range.
struct ReportCurve {
  std::string title, note, x_label, y_label;
  std::vector<double> x, middle, low, high;
};

// A cut through the body: square cells, row by row from the lower left corner.
struct ReportSlice {
  std::string title;            // "z = 12.0 mm"
  std::string right, up;        // axes: "x [mm]"
  double left = 0, bottom = 0;  // of the corner [m]
  double cell = 1;              // edge [m]
  int columns = 0;
  std::vector<double> modulus;  // of a cell, E [Pa]; 0 outside the body
};

// What one model version lacks.
struct ReportDiagnosis {
  std::string version;  // name of the model version, "" when there is only one diagnosis
  std::vector<DiagnosisRow> rows;
};

struct Report {
  std::string title;
  std::string verdict;          // one line
  bool good = false;            // colours the verdict
  std::string next;             // the next step: most often a command
  bool next_is_command = true;  // it can be copied
  std::vector<KeyNumber> numbers;
  std::vector<std::string> sentences;
  ReportTable history;     // no rows: not shown
  ReportTable parameters;  // no rows: not shown
  std::vector<ReportVersion> versions;
  double mesh_uncertainty = std::numeric_limits<double>::quiet_NaN();  // [N]
  std::vector<ReportDiagnosis> diagnoses;
  ReportBody body;
  ReportInside inside;
  std::vector<std::string> curves;  // names of the simulated versions, the compared one last
  std::vector<ReportPress> presses;
  std::string presses_note;  // what was left out for the file's size
  std::string time_label = "time [s]";
  std::vector<ResidualPlot> residuals;
  std::vector<ReportCurve> learned;
  std::vector<ReportSlice> slices;
  std::vector<ReportTable> tables;
  std::vector<std::pair<std::string, std::string>> provenance;
};

// One HTML file that needs nothing else and no network.
void write_report(std::ostream& out, const Report& report);

}  // namespace hapsim
