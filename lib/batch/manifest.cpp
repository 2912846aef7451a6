#include "batch/manifest.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <map>

#include "base/error.h"
#include "base/nearest.h"
#include "base/shell_words.h"
#include "batch/option_files.h"
#include "io/csv.h"
#include "io/quantity.h"

namespace hapsim {
namespace {

const std::vector<std::string> kColumns{"name", "body",    "scan",      "data",          "raw",
                                        "tool", "effects", "scan_unit", "common_options"};

bool is_known(const std::string& column) {
  for (const BatchStage& stage : kBatchStages)
    if (column == stage.column) return true;
  return std::find(kColumns.begin(), kColumns.end(), column) != kColumns.end();
}

// A column that is a letter away from a known one is a mistake, not a column of the user's own.
void check_columns(const CsvTable& table) {
  const bool raw = table.find("raw") >= 0;
  for (const char* column : {"name", "data"})
    if (table.find(column) < 0 && !(raw && column == std::string("data")))
      fail_missing_column(table.name, column, table.header, kColumns);
  if (table.find("body") < 0 && table.find("scan") < 0 && !raw)
    fail_input(table.name, "there is neither a column 'body' nor a column 'scan'",
               "name the body, or the scan of which it is made, in every row");
  std::vector<std::string> known = kColumns;
  for (const BatchStage& stage : kBatchStages) known.emplace_back(stage.column);
  for (const std::string& column : table.header) {
    const std::string near = is_known(column) ? "" : nearest(column, known);
    if (!near.empty())
      fail_input(table.name, "the column " + shown(column) + " is not known",
                 "did you mean '" + near + "'? name columns of your own less like it");
  }
}

std::size_t number_of(const std::string& step) {
  const auto found = std::find_if(kBatchStages.begin(), kBatchStages.end(),
                                  [&](const BatchStage& s) { return step == s.step; });
  return static_cast<std::size_t>(found - kBatchStages.begin());
}

// The path as seen from here, when it is given as seen from the manifest's folder.
std::string from_here(const std::string& manifest, const std::string& path) {
  const std::size_t slash = manifest.rfind('/');
  if (path.empty() || path[0] == '/') return path;
  if (slash != manifest.npos) return manifest.substr(0, slash + 1) + path;
  return path[0] == '-' ? "./" + path : path;  // not to be taken for a flag
}

void require_file(const std::string& what, const std::string& path, const std::string& where) {
  const std::string mend = "paths are relative to the manifest's folder";
  struct stat info = {};
  if (path.find('\n') != path.npos)
    fail_input(where, "the name of the " + what + " has a line break", "rename the file");
  if (stat(path.c_str(), &info) != 0)
    fail_input(where, fmt::format("{} '{}': {}", what, path, std::strerror(errno)), mend);
  if (S_ISDIR(info.st_mode))
    fail_input(where, fmt::format("{} '{}' is a folder", what, path), "name a file");
  // A pipe or a terminal would be waited for without end.
  if (!S_ISREG(info.st_mode))
    fail_input(where, fmt::format("{} '{}' is no file but a pipe, socket or device", what, path),
               "write what comes from it to a file first");
  if (access(path.c_str(), R_OK) != 0)
    fail_input(where, fmt::format("{} '{}': {}", what, path, std::strerror(errno)),
               "make it readable");
}

std::string joined_by_commas(std::string text) {
  std::string list;
  for (char& c : text)
    if (c == ',' || c == '+' || c == ';') c = ' ';
  for (const std::string& word : split_words(text, "effects"))
    list += (list.empty() ? "" : ",") + word;
  return list;
}

bool states_block(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "--block" || word.rfind("--block=", 0) == 0;
  });
}

void require_sources(const ManifestRow& row, const std::string& where) {
  if (row.data.empty() && row.raw.empty())
    fail_input(where, "no data are named", "fill in the column data, or raw");
  if (!row.data.empty() && !row.raw.empty())
    fail_input(where, "data and raw exclude each other", "fill in one of the two");
  if (!row.body.empty() && !row.scan.empty())
    fail_input(where, "body and scan exclude each other", "fill in one of the two");
  if (row.body.empty() && row.scan.empty() && !row.block)
    fail_input(where, "there is neither body nor scan",
               row.raw.empty() ? "fill in one of the two"
                               : "fill in one of the two, or --block in import_options");
  for (const auto& [what, path] : {std::pair{"data", &row.data}, std::pair{"raw", &row.raw},
                                   std::pair{"body", &row.body}, std::pair{"scan", &row.scan}})
    if (!path->empty()) require_file(what, *path, where);
  for (std::size_t s = 0; s < kBatchStages.size(); ++s)
    for (const std::string& path : row.option_files[s])
      require_file(kBatchStages[s].column, path, where);
  for (const std::string& path : row.common_files) require_file("common_options", path, where);
}

void fill(ManifestRow& row, const CsvTable& table, std::size_t r, const std::string& where) {
  const auto cell = [&](const char* column) -> std::string {
    const int c = table.find(column);
    return c < 0 ? "" : std::string(trim(table.columns[static_cast<std::size_t>(c)][r]));
  };
  const auto here = [&table](const std::string& path) { return from_here(table.name, path); };
  for (std::size_t s = 0; s < kBatchStages.size(); ++s) {
    row.options[s] = split_words(cell(kBatchStages[s].column), where);
    row.option_files[s] = name_files(row.options[s], here);
  }
  row.common = split_words(cell("common_options"), where);
  row.common_files = name_files(row.common, here);
  row.data = from_here(table.name, cell("data"));
  row.raw = from_here(table.name, cell("raw"));
  row.body = from_here(table.name, cell("body"));
  row.scan = from_here(table.name, cell("scan"));
  if (!cell("scan_unit").empty()) row.scan_unit = cell("scan_unit");
  if (!cell("effects").empty()) row.effects = joined_by_commas(cell("effects"));
  if (row.name.empty()) fail_input(where, "the recording has no name", "give each row a name");
  if (const std::string tool = cell("tool"); !tool.empty()) {
    row.tool_radius = parse_length_at(where, tool, "tool");
    if (!(row.tool_radius > 0 && row.tool_radius < 1))
      fail_input(where, "the tool's radius " + shown(tool) + " is not between 0 and 1 m",
                 "write it with its unit: 4mm");
  }
  row.block = !row.raw.empty() && row.body.empty() && row.scan.empty() &&
              states_block(options_of(row, "data"));
  require_sources(row, where);
}

}  // namespace

const std::vector<std::string>& options_of(const ManifestRow& row, const std::string& step) {
  return row.options[number_of(step)];
}
const std::vector<std::string>& option_files_of(const ManifestRow& row, const std::string& step) {
  return row.option_files[number_of(step)];
}

namespace {

bool ends_in_hash(const std::string& name) {
  constexpr std::size_t kDigits = 16;
  if (name.size() <= kDigits || name[name.size() - kDigits - 1] != '-') return false;
  return name.find_first_not_of("0123456789abcdef", name.size() - kDigits) == name.npos;
}

}  // namespace

std::string plain_name(const std::string& text) {
  constexpr std::size_t kLongest = 80;
  std::string plain;
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                      c == '_' || c == '-' || c == '.';
    if (good && (c != '.' || !plain.empty()))
      plain += c;
    else if (!plain.empty() && plain.back() != '-')
      plain += '-';
  }
  if (plain.size() > kLongest) plain.resize(kLongest);
  // A name that looks as if it had a hash could be the name of another text.
  return plain == text && !ends_in_hash(plain) ? plain : fmt::format("{}-{:016x}", plain, hash);
}

Manifest read_manifest(Input& input) {
  const CsvTable table = read_csv(input);
  check_columns(table);
  if (table.rows() == 0)
    fail_input(table.name, "the manifest has no rows", "give it a row a recording");
  Manifest manifest;
  manifest.name = table.name;
  std::vector<std::size_t> extra;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    if (!is_known(table.header[c])) {
      extra.push_back(c);
      manifest.extra_header.push_back(table.header[c]);
    }
  std::map<std::string, long> lines;    // of the names
  std::map<std::string, long> folders;  // whose hashes somebody could have made equal
  for (std::size_t r = 0; r < table.rows(); ++r) {
    ManifestRow row;
    row.line = table.line[r];
    row.name = table.columns[static_cast<std::size_t>(table.find("name"))][r];
    row.folder = plain_name(row.name);
    for (const std::size_t c : extra) row.extra.push_back(table.columns[c][r]);
    const std::string where = fmt::format("{}:{}", table.name, row.line);
    try {
      const auto [first, added] = lines.emplace(row.name, row.line);
      if (!added)
        fail_input(
            where,
            fmt::format("the name {} stands in line {} already", shown(row.name), first->second),
            "give each recording its own name");
      if (const auto [other, fresh] = folders.emplace(row.folder, row.line); !fresh)
        fail_input(where, fmt::format("its folder would be that of line {}", other->second),
                   "give it another name");
      fill(row, table, r, where);
    } catch (const Error& error) {
      row.problem = error.what();
    }
    manifest.rows.push_back(std::move(row));
  }
  return manifest;
}

}  // namespace hapsim
