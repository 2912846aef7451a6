// An SQLite file that many processes may read and write at once.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace hapsim {

// What a file must be, so that no foreign database is taken for ours.
struct DatabaseFormat {
  std::string what;        // "model library", for messages
  int application_id = 0;  // PRAGMA application_id of the file
  int version = 1;         // of the schema, PRAGMA user_version
  std::string schema;      // statements that make an empty file one of this version
};

using Cell = std::variant<std::nullptr_t, std::int64_t, double, std::string>;
using Row = std::vector<Cell>;

std::string text_of(const Cell& cell);  // "" for null
double number_of(const Cell& cell);     // NaN for null and text

// One connection, for one thread. The file is in rollback mode, not write-ahead: it stays one file
// that can be copied, and what a killed process left half-written is undone when it is next opened.
//
// Error(kIo): cannot be opened, read or written; another process holds it for longer than
// `patience` seconds. Error(kBadInput): no SQLite file, damaged, another program's, of a newer
// version, or with a trigger, view, index or table that the format does not have.
class Database {
 public:
  enum class Mode { kRead, kWrite };  // kWrite makes a file that is absent
  Database(const std::string& path, const DatabaseFormat& format, Mode mode, double patience = 10);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  // Runs one statement with its `?` filled in.
  std::vector<Row> query(const std::string& sql, const Row& values = {});
  std::int64_t last_id() const;  // of the last row inserted
  const std::string& path() const { return path_; }

  // Holds the file against other writers until commit(); undone without it.
  class Transaction {
   public:
    explicit Transaction(Database& database);
    ~Transaction();
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    void commit();

   private:
    Database& database_;
    bool open_ = true;
  };

 private:
  explicit Database(const DatabaseFormat& format);  // an empty one, in memory
  [[noreturn]] void fail(int code) const;
  void check_format(Mode mode);
  void check_schema();

  struct Handle;
  std::unique_ptr<Handle> handle_;
  std::string path_;
  DatabaseFormat format_;
  double patience_;
};

}  // namespace hapsim
