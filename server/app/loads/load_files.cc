#include "server/app/loads/load_files.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/system/json_text.h"
#include "render/image/new_file.h"
#include "server/app/loads/load_rows.h"

namespace kinescope::app {
namespace {

// A new file, or standard output. Collects small pieces.
class Output {
 public:
  explicit Output(const std::string& path) {
    if (path != "-") file_.emplace(path);
  }
  std::string& buffer() { return buffer_; }
  void FlushWhenLarge() {
    constexpr std::size_t kLarge = 1 << 16;
    if (buffer_.size() >= kLarge) Flush();
  }
  void Finish() {
    Flush();
    if (file_) {
      file_->Commit();
    } else if (std::fflush(stdout) != 0) {
      throw std::runtime_error("cannot write to standard output");
    }
  }

 private:
  void Flush() {
    if (file_) {
      file_->Write(buffer_.data(), buffer_.size());
    } else if (std::fwrite(buffer_.data(), 1, buffer_.size(), stdout) != buffer_.size()) {
      throw std::runtime_error("cannot write to standard output");
    }
    buffer_.clear();
  }
  std::optional<render::NewFile> file_;
  std::string buffer_;
};

// The shortest text that reads back as the same number, so that others can count what we counted.
std::string FormatNumber(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

class CsvNames : public CellSink {
 public:
  explicit CsvNames(std::string& line) : line_(line) {}
  void Number(const std::string& name, double) override { Push(name); }
  void Whole(const std::string& name, long long) override { Push(name); }
  void Text(const std::string& name, std::string_view) override { Push(name); }

 private:
  void Push(const std::string& name) {
    if (!is_first_) line_ += ',';
    is_first_ = false;
    line_ += name;
  }
  std::string& line_;
  bool is_first_ = true;
};

class CsvValues : public CellSink {
 public:
  explicit CsvValues(std::string& line) : line_(line) {}
  void Number(const std::string&, double value) override { Push(FormatNumber(value)); }
  void Whole(const std::string&, long long value) override { Push(std::to_string(value)); }
  void Text(const std::string&, std::string_view value) override {
    if (value.find_first_of(",\"\r\n") == std::string_view::npos) return Push(value);
    std::string quoted = "\"";
    for (const char c : value) quoted += c == '"' ? "\"\"" : std::string(1, c);
    Push(quoted + '"');
  }

 private:
  void Push(std::string_view value) {
    if (!is_first_) line_ += ',';
    is_first_ = false;
    line_ += value;
  }
  std::string& line_;
  bool is_first_ = true;
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
  Output out_;
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
  JsonFile(const std::string& path, const Columns& columns) : out_(path), columns_(columns) {
    out_.buffer() += fmt::format("{{\"schema\":\"{}\",", kLoadsSchema);
  }

  void Add(const PersonState& person, std::int64_t begin_nanos) override {
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
  Output out_;
  const Columns columns_;
  std::uint64_t samples_ = 0;
};

}  // namespace

std::unique_ptr<LoadFile> MakeCsv(const std::string& path, Layout layout, const Columns& columns) {
  return std::make_unique<Csv>(path, layout, columns);
}

std::unique_ptr<LoadFile> MakeJson(const std::string& path, const Columns& columns) {
  return std::make_unique<JsonFile>(path, columns);
}

}  // namespace kinescope::app
