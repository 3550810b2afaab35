#include "server/app/loads/load_files.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/system/json_text.h"
#include "server/table/csv_row.h"
#include "server/table/load_rows.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

// The shortest text that reads back as the same number, so that others can count what we counted.
std::string FormatNumber(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

class CsvNames : public CellSink {
 public:
  explicit CsvNames(std::string& line) : row_(line) {}
  void Number(const std::string& name, double) override { row_.Text(name); }
  void Whole(const std::string& name, long long) override { row_.Text(name); }
  void Text(const std::string& name, std::string_view) override { row_.Text(name); }

 private:
  CsvRow row_;
};

class CsvValues : public CellSink {
 public:
  explicit CsvValues(std::string& line) : row_(line) {}
  void Number(const std::string&, double value) override { row_.Number(value); }
  void Whole(const std::string&, long long value) override { row_.Whole(value); }
  void Text(const std::string&, std::string_view value) override { row_.Text(value); }

 private:
  CsvRow row_;
};

class Csv : public LoadFile {
 public:
  Csv(const std::string& path, Layout layout, const Columns& columns)
      : out_(path), layout_(layout), columns_(columns), joints_(JointsOf(columns)) {}

  void Add(const PersonState& person, std::int64_t begin_nanos) override {
    if (!has_header_) WriteRows<CsvNames>(person, begin_nanos, 1);
    has_header_ = true;
    WriteRows<CsvValues>(person, begin_nanos, joints_.size());
    out_.FlushWhenLarge();
  }
  void Finish(const nlohmann::json&) override { out_.Finish(); }

 private:
  template <class Sink>
  void WriteRows(const PersonState& person, std::int64_t begin_nanos, std::size_t joints) {
    const std::size_t rows = layout_ == Layout::kWide ? 1 : joints;
    for (std::size_t i = 0; i < rows; ++i) {
      Sink cells(out_.buffer());
      if (layout_ == Layout::kWide) {
        VisitWide(person, begin_nanos, columns_, cells);
      } else {
        VisitTime(person, begin_nanos, cells);
        cells.Text("joint", ColumnNameOf(joints_[i]));
        VisitJoint(person, joints_[i], "", columns_, cells);
      }
      out_.buffer() += '\n';
    }
  }
  OutputFile out_;
  const Layout layout_;
  const Columns columns_;
  const std::vector<int> joints_;
  bool has_header_ = false;
};

class JsonNames : public CellSink {
 public:
  nlohmann::json names = nlohmann::json::array();
  void Number(const std::string& name, double) override { names.push_back(name); }
  void Whole(const std::string& name, long long) override { names.push_back(name); }
  void Text(const std::string& name, std::string_view) override { names.push_back(name); }
};

class JsonValues : public CellSink {
 public:
  explicit JsonValues(std::string& line) : line_(line) {}
  void Number(const std::string&, double value) override {
    const std::string text = FormatNumber(value);
    Push(text.empty() ? "null" : text);
  }
  void Whole(const std::string&, long long value) override { Push(std::to_string(value)); }
  void Text(const std::string&, std::string_view value) override {
    Push(value.empty() ? "null" : JsonText(nlohmann::json(value)));
  }

 private:
  void Push(const std::string& value) {
    line_ += line_.empty() || line_.back() == '[' ? "" : ",";
    line_ += value;
  }
  std::string& line_;
};

// One object on one line, as every --json.
class JsonFile : public LoadFile {
 public:
  JsonFile(const std::string& path, const Columns& columns, bool has_samples)
      : out_(path), columns_(columns), has_samples_(has_samples) {
    out_.buffer() += fmt::format("{{\"schema\":\"{}\",", kLoadsSchema);
  }

  void Add(const PersonState& person, std::int64_t begin_nanos) override {
    if (!has_samples_) return;
    if (samples_++ == 0) {
      JsonNames header;
      VisitWide(person, begin_nanos, columns_, header);
      out_.buffer() += "\"columns\":" + JsonText(header.names) + ",\"samples\":[";
    } else {
      out_.buffer() += ",";
    }
    std::string line = "[";
    JsonValues cells(line);
    VisitWide(person, begin_nanos, columns_, cells);
    out_.buffer() += line + "]";
    out_.FlushWhenLarge();
  }

  void Finish(const nlohmann::json& summary) override {
    if (samples_ == 0) out_.buffer() += "\"columns\":[],\"samples\":[";
    out_.buffer() += "]";
    for (const auto& [key, value] : summary.items()) {
      out_.buffer() += fmt::format(",\"{}\":{}", key, JsonText(value));
    }
    out_.buffer() += "}\n";
    out_.Finish();
  }

 private:
  OutputFile out_;
  const Columns columns_;
  const bool has_samples_;
  std::uint64_t samples_ = 0;
};

}  // namespace

std::unique_ptr<LoadFile> MakeCsv(const std::string& path, Layout layout, const Columns& columns) {
  return std::make_unique<Csv>(path, layout, columns);
}

std::unique_ptr<LoadFile> MakeJson(const std::string& path, const Columns& columns,
                                   bool has_samples) {
  return std::make_unique<JsonFile>(path, columns, has_samples);
}

}  // namespace kinescope::app
