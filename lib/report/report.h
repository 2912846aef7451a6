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

struct ReportBody {
  std::vector<Vec3> vertices;             // [m]
  std::vector<std::array<int, 3>> faces;  // may be empty: only the positions are shown
  std::vector<double> error;              // one a vertex [N]
  std::vector<double> distance;           // one a vertex: to the nearest position [m]
  double reach = 1;                       // [m]; beyond it the surface is grey
  std::vector<Vec3> positions;            // [m]
  std::vector<double> position_error;     // [N]
  double noise = 0;                       // [N], marked on the colour bar
};

struct DiagnosisRow {
  std::string rank, effect, verdict;
  std::vector<std::pair<std::string, std::string>> facts;  // short cells: name, text
  std::vector<std::pair<std::string, std::string>> notes;  // long text: name, text
  std::string command;
};

// What one model version lacks.
struct ReportDiagnosis {
  std::string version;  // name of the model version, "" when there is only one diagnosis
  std::vector<DiagnosisRow> rows;
};

struct Report {
  std::string title;
  std::string verdict;  // one line
  bool good = false;    // colours the verdict
  std::vector<KeyNumber> numbers;
  std::vector<std::string> sentences;
  ReportTable history;  // no rows: not shown
  std::vector<ReportVersion> versions;
  std::vector<ReportDiagnosis> diagnoses;
  ReportBody body;
  std::vector<std::string> curves;  // names of the simulated versions, the compared one last
  std::vector<ReportPress> presses;
  std::string presses_note;  // what was left out for the file's size
  std::string time_label = "time [s]";
  std::vector<ResidualPlot> residuals;
  std::vector<ReportTable> tables;
  std::vector<std::pair<std::string, std::string>> provenance;
};

// One HTML file that needs nothing else and no network.
void write_report(std::ostream& out, const Report& report);

}  // namespace hapsim
