#include "io/database.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cmath>
#include <limits>
#include <set>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {

struct Database::Handle {
  sqlite3* db = nullptr;
  ~Handle() { sqlite3_close_v2(db); }
};

namespace {

struct Finalise {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalise>;

int bind(sqlite3_stmt* statement, int at, const Cell& cell) {
  if (const auto* integer = std::get_if<std::int64_t>(&cell))
    return sqlite3_bind_int64(statement, at, *integer);
  if (const auto* number = std::get_if<double>(&cell))
    return std::isnan(*number) ? sqlite3_bind_null(statement, at)
                               : sqlite3_bind_double(statement, at, *number);
  if (const auto* text = std::get_if<std::string>(&cell))
    return sqlite3_bind_text(statement, at, text->c_str(), static_cast<int>(text->size()),
                             SQLITE_TRANSIENT);
  return sqlite3_bind_null(statement, at);
}

Cell column(sqlite3_stmt* statement, int at) {
  switch (sqlite3_column_type(statement, at)) {
    case SQLITE_INTEGER:
      return static_cast<std::int64_t>(sqlite3_column_int64(statement, at));
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, at);
    case SQLITE_NULL:
      return nullptr;
    default: {
      const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, at));
      return std::string(bytes, bytes + sqlite3_column_bytes(statement, at));
    }
  }
}

// What a file's schema says may run when it is asked or written: a file is somebody else's. No
// trigger, no view, no function with effects out of a schema, nothing that writes past it.
void take_no_orders(sqlite3* db) {
  for (const int off : {SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW,
                        SQLITE_DBCONFIG_TRUSTED_SCHEMA, SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION})
    sqlite3_db_config(db, off, 0, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_exec(db, "PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0", nullptr, nullptr, nullptr);
}

constexpr const char* kObjects =
    "SELECT type, name, tbl_name, coalesce(sql, '') FROM sqlite_master "
    // What ANALYZE writes.
    "WHERE NOT (type = 'table' AND name LIKE 'sqlite\\_stat_' ESCAPE '\\')";

}  // namespace

std::string text_of(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return std::to_string(*integer);
  if (const auto* number = std::get_if<double>(&cell)) return fmt::format("{}", *number);
  return "";
}

double number_of(const Cell& cell) {
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) return static_cast<double>(*integer);
  if (const auto* number = std::get_if<double>(&cell)) return *number;
  return std::numeric_limits<double>::quiet_NaN();
}

Database::Database(const std::string& path, const DatabaseFormat& format, Mode mode,
                   double patience)
    : handle_(std::make_unique<Handle>()), path_(path), format_(format), patience_(patience) {
  // A reader too undoes what a killed writer left; where it may not write, SQLite opens the file
  // for reading alone.
  const int flags = SQLITE_OPEN_READWRITE | (mode == Mode::kWrite ? SQLITE_OPEN_CREATE : 0);
  // Without URI names: a path is a path.
  if (const int code = sqlite3_open_v2(path.c_str(), &handle_->db, flags, nullptr);
      code != SQLITE_OK)
    fail(code);
  sqlite3_extended_result_codes(handle_->db, 1);
  sqlite3_busy_timeout(handle_->db, static_cast<int>(1000 * patience));
  take_no_orders(handle_->db);
  check_format(mode);
}

Database::Database(const DatabaseFormat& format)
    : handle_(std::make_unique<Handle>()), path_(":memory:"), format_(format), patience_(0) {
  if (sqlite3_open_v2(":memory:", &handle_->db, SQLITE_OPEN_READWRITE, nullptr) != SQLITE_OK ||
      sqlite3_exec(handle_->db, format_.schema.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    fail(SQLITE_NOMEM);
}

Database::~Database() = default;

void Database::check_format(Mode mode) {
  const auto integer = [&](const char* pragma) {
    return static_cast<int>(number_of(query(pragma).at(0).at(0)));
  };
  const auto is_empty = [&] { return query("SELECT 1 FROM sqlite_master LIMIT 1").empty(); };
  if (mode == Mode::kWrite && integer("PRAGMA application_id") == 0 && is_empty()) {
    Transaction transaction(*this);
    // Another process may have made it meanwhile.
    if (is_empty()) {
      if (sqlite3_exec(handle_->db, format_.schema.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
        fail(sqlite3_extended_errcode(handle_->db));
      query(fmt::format("PRAGMA application_id = {}", format_.application_id));
      query(fmt::format("PRAGMA user_version = {}", format_.version));
    }
    transaction.commit();
  }
  if (mode == Mode::kRead && is_empty())
    fail_input(path_, "there is no " + format_.what + " in this file", "name another file");
  if (integer("PRAGMA application_id") != format_.application_id)
    fail_input(path_, "this is the database of another program, no " + format_.what,
               "name another file");
  if (const int version = integer("PRAGMA user_version"); version != format_.version)
    fail_input(
        path_,
        fmt::format("this {} has version {} of its format, and only version {} is known",
                    format_.what, version, format_.version),
        version > format_.version ? "use the newer hapsim that wrote it" : "name another file");
  check_schema();
  const std::vector<Row> checked = query("PRAGMA quick_check(1)");
  if (checked.empty() || text_of(checked[0].at(0)) != "ok") fail(SQLITE_CORRUPT);
}

// Before anything that could evaluate an expression of it.
void Database::check_schema() {
  const auto objects = [](const std::vector<Row>& rows) {
    std::set<std::string> lines;
    for (const Row& row : rows) {
      std::string line;
      for (const Cell& cell : row) line += text_of(cell) + '\n';
      lines.insert(line);
    }
    return lines;
  };
  // What the schema makes of an empty file, in memory.
  Database model(format_);
  const std::set<std::string> ours = objects(model.query(kObjects));
  const std::set<std::string> theirs = objects(query(kObjects));
  if (theirs == ours) return;
  for (const std::string& object : theirs)
    if (ours.count(object) == 0)
      fail_input(
          path_,
          fmt::format("it holds a {} that no {} has: {}", object.substr(0, object.find('\n')),
                      format_.what, shown(object.substr(object.find('\n') + 1))),
          "somebody has put it there; restore the file from a copy");
  fail(SQLITE_CORRUPT);
}

std::vector<Row> Database::query(const std::string& sql, const Row& values) {
  sqlite3_stmt* raw = nullptr;
  if (const int code = sqlite3_prepare_v2(handle_->db, sql.c_str(), -1, &raw, nullptr);
      code != SQLITE_OK)
    fail(code);
  const Statement statement(raw);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (const int code = bind(raw, static_cast<int>(i) + 1, values[i]); code != SQLITE_OK)
      fail(code);
  std::vector<Row> rows;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(raw)) == SQLITE_ROW) {
    Row& row = rows.emplace_back();
    for (int c = 0; c < sqlite3_column_count(raw); ++c) row.push_back(column(raw, c));
  }
  if (code != SQLITE_DONE) fail(code);
  return rows;
}

std::int64_t Database::last_id() const {
  return sqlite3_last_insert_rowid(handle_->db);
}

void Database::fail(int code) const {
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      fail_io(path_,
              fmt::format("another process has held this {} for {:g} s", format_.what, patience_),
              "wait until it has ended, or end it");
    case SQLITE_READONLY:
      fail_io(path_, "it may not be written", "give the file and its folder write permission");
    case SQLITE_CANTOPEN:
      fail_io(path_, "cannot be opened", "check the name and the permissions");
    case SQLITE_IOERR:
    case SQLITE_FULL:
    case SQLITE_PERM:
    case SQLITE_NOMEM:
    case SQLITE_PROTOCOL:
    case SQLITE_NOLFS:
      fail_io(path_, handle_->db ? sqlite3_errmsg(handle_->db) : sqlite3_errstr(code),
              "check the disk and the permissions");
    default:  // damage shows in many ways: no database, no such column, an unknown file format
      fail_input(path_, "this is no " + format_.what + ", or it is damaged",
                 "restore it from a copy, or name another file");
  }
}

Database::Transaction::Transaction(Database& database) : database_(database) {
  database_.query("BEGIN IMMEDIATE");
}

Database::Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_.query("ROLLBACK");
  } catch (const Error&) {
    // Closing the connection undoes it as well.
  }
}

void Database::Transaction::commit() {
  database_.query("COMMIT");
  open_ = false;
}

}  // namespace hapsim
