#include "server/app/convert/motion_csv.h"

#include <cmath>

#include "server/table/csv_row.h"
#include "server/table/load_rows.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

// A sample's own cells, before its values.
void AddTimes(const PersonState& person, std::int64_t begin_nanos, CsvRow& row) {
  const BodySample& sample = person.sample;
  row.Number(SecsSince(begin_nanos, sample.stamp_nanos));
  row.Text(sample.has_time_of_day ? IsoTime(sample.stamp_nanos) : "");
  row.Whole(sample.counter);
  row.Whole(person.character);
}

void AddTimeNames(CsvRow& row) {
  for (const char* name : {"time_s", "utc", "sample_counter", "person"}) row.Text(name);
}

class HeaderCells : public MotionCells {
 public:
  explicit HeaderCells(CsvRow& row) : row_(row) {}
  void Number(const MotionCell& cell, double) override { row_.Text(ColumnName(cell)); }
  void Text(const MotionCell& cell, std::string_view) override { row_.Text(ColumnName(cell)); }

 private:
  CsvRow& row_;
};

class ValueCells : public MotionCells {
 public:
  explicit ValueCells(CsvRow& row) : row_(row) {}
  void Number(const MotionCell&, double value) override { row_.Number(value); }
  void Text(const MotionCell&, std::string_view value) override { row_.Text(value); }

 private:
  CsvRow& row_;
};

// Unknown values have no row.
class LongCells : public MotionCells {
 public:
  /// `times`: the sample's cells as text, without a separator behind them.
  LongCells(const std::string& times, std::string& provenance, std::string& out)
      : times_(times), provenance_(provenance), out_(out) {}

  void Number(const MotionCell& cell, double value) override {
    if (!std::isfinite(value)) return;
    CsvRow row = Begin(cell);
    row.Number(value);
    row.Empty();
    End(row);
  }
  void Text(const MotionCell& cell, std::string_view value) override {
    if (value.empty()) return;
    CsvRow row = Begin(cell);
    row.Empty();
    row.Text(value);
    End(row);
  }

 private:
  CsvRow Begin(const MotionCell& cell) {
    out_ += times_;
    out_ += ',';
    CsvRow row(out_);
    for (const auto part : {cell.item, cell.quantity, cell.component, cell.unit}) row.Text(part);
    return row;
  }
  void End(CsvRow& row) {
    row.Text(provenance_);
    provenance_.clear();
    row.End();
  }

  const std::string& times_;
  std::string& provenance_;
  std::string& out_;
};

class MotionCsv : public MotionFile {
 public:
  MotionCsv(const std::string& path, const MotionOutline& outline)
      : path_(path), outline_(outline), provenance_(outline.provenance), out_(path) {}

  void Add(const PersonState& person, std::int64_t /*frame*/) override {
    if (!has_header_) WriteHeader(person);
    if (outline_.layout == TableLayout::kWide) {
      CsvRow row(out_.buffer());
      AddTimes(person, outline_.begin_nanos, row);
      ValueCells cells(row);
      VisitMotion(person, outline_.quantities, outline_.trackers, cells);
      row.Text(provenance_);
      provenance_.clear();
      row.End();
    } else {
      times_.clear();
      CsvRow row(times_);
      AddTimes(person, outline_.begin_nanos, row);
      LongCells cells(times_, provenance_, out_.buffer());
      VisitMotion(person, outline_.quantities, outline_.trackers, cells);
    }
    if ((person.sample.has_tracker & ~outline_.trackers).any()) ++late_trackers_;
    out_.FlushWhenLarge();
  }

  void Finish() override { out_.Finish(); }
  std::vector<std::string> paths() const override { return {path_}; }
  std::vector<std::string> notes() const override {
    const bool has_trackers =
        outline_.quantities.test(static_cast<std::size_t>(Quantity::kTrackers));
    if (late_trackers_ == 0 || !has_trackers) return {};
    return {path_ + ": trackers that appeared after the first second have no columns"};
  }

 private:
  void WriteHeader(const PersonState& person) {
    has_header_ = true;
    CsvRow row(out_.buffer());
    AddTimeNames(row);
    if (outline_.layout == TableLayout::kWide) {
      HeaderCells cells(row);
      VisitMotion(person, outline_.quantities, outline_.trackers, cells);
    } else {
      for (const char* name : {"item", "quantity", "component", "unit", "value", "text"}) {
        row.Text(name);
      }
    }
    row.Text("provenance");
    row.End();
  }

  const std::string path_;
  const MotionOutline outline_;
  std::string provenance_;  // until it is written
  OutputFile out_;
  std::string times_;
  bool has_header_ = false;
  std::uint64_t late_trackers_ = 0;
};

}  // namespace

std::unique_ptr<MotionFile> MakeMotionCsv(const std::string& path, const MotionOutline& outline) {
  return std::make_unique<MotionCsv>(path, outline);
}

}  // namespace kinescope::app
