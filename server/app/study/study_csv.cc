#include "server/app/study/study_csv.h"

#include <set>
#include <string_view>
#include <vector>

#include "core/scene_state.h"
#include "server/table/csv_row.h"
#include "server/table/load_rows.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

constexpr std::string_view kTrialColumns[] = {"trial",      "state",     "reason",  "source",
                                              "mvn_person", "mvn_name",  "sex",     "mass_kg",
                                              "height_m",   "hand_load", "samples", "seconds"};
constexpr std::string_view kJointColumns[] = {"joint",
                                              "low_pct",
                                              "medium_pct",
                                              "high_pct",
                                              "unknown_pct",
                                              "p10",
                                              "p50",
                                              "p90",
                                              "peak_ratio",
                                              "peak_time_s",
                                              "peak_channel",
                                              "peak_moment_Nm",
                                              "longest_high_s",
                                              "rises_high",
                                              "rises_high_per_min"};
constexpr std::string_view kSpineColumns[] = {
    "l5_s1_compression_mean_N", "l5_s1_compression_peak_N", "l5_s1_compression_above_3400_s"};

bool IsColumn(const std::string& name) {
  for (const auto& columns :
       {std::vector<std::string_view>(std::begin(kTrialColumns), std::end(kTrialColumns)),
        std::vector<std::string_view>(std::begin(kJointColumns), std::end(kJointColumns)),
        std::vector<std::string_view>(std::begin(kSpineColumns), std::end(kSpineColumns))}) {
    for (const std::string_view column : columns) {
      if (column == name) return true;
    }
  }
  return false;
}

std::set<std::string> LabelsOf(const Study& study) {
  std::set<std::string> labels;
  for (const StudyTrial& trial : study.trials) {
    for (const auto& [name, value] : trial.labels) labels.insert(name);
  }
  return labels;
}

class Rows {
 public:
  Rows(const Study& study, std::string& out) : labels_(LabelsOf(study)), out_(out) {}

  void WriteNames() {
    CsvRow row(out_);
    row.Text(kTrialColumns[0]);
    for (const std::string& label : labels_) row.Text(IsColumn(label) ? "label_" + label : label);
    for (std::size_t i = 1; i < std::size(kTrialColumns); ++i) row.Text(kTrialColumns[i]);
    for (const std::string_view name : kJointColumns) row.Text(name);
    for (const std::string_view name : kSpineColumns) row.Text(name);
    row.End();
  }

  void Write(const StudyTrial& trial) {
    if (!trial.loads) {
      CsvRow row(out_);
      WriteTrial(trial, row);
      for (std::size_t i = 0; i < std::size(kJointColumns) + std::size(kSpineColumns); ++i)
        row.Empty();
      row.End();
      return;
    }
    for (std::size_t joint = 0; joint < trial.loads->joints.size(); ++joint) {
      CsvRow row(out_);
      WriteTrial(trial, row);
      row.Text(ScoredName(joint));
      WriteJoint(trial.loads->joints[joint], row);
      row.Number(trial.loads->compression_mean_N);
      row.Number(trial.loads->compression_most_N);
      row.Number(trial.loads->compression_above_secs);
      row.End();
    }
  }

 private:
  void WriteTrial(const StudyTrial& trial, CsvRow& row) const {
    row.Text(trial.id);
    for (const std::string& label : labels_) {
      const auto found = trial.labels.find(label);
      row.Text(found == trial.labels.end() ? "" : found->second);
    }
    row.Text(trial.state);
    row.Text(trial.loads ? "" : trial.reason);
    row.Text(trial.source);
    if (!trial.loads) {
      for (int i = 0; i < 8; ++i) row.Empty();
      return;
    }
    row.Whole(trial.loads->number);
    row.Text(trial.loads->name);
    row.Text(trial.loads->sex);
    row.Number(trial.loads->mass_kg);
    row.Number(trial.loads->height_m);
    row.Text(trial.loads->hand_load);
    row.Whole(static_cast<long long>(trial.loads->samples));
    row.Number(trial.loads->secs);
  }

  static void WriteJoint(const JointLoads& joint, CsvRow& row) {
    for (const LoadClass band :
         {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh, LoadClass::kUnknown}) {
      row.Number(joint.Percent(band));
    }
    for (const double value : {joint.p10, joint.p50, joint.p90, joint.peak, joint.peak_secs}) {
      row.Number(value);
    }
    row.Text(joint.peak_channel);
    row.Number(joint.peak_moment_Nm);
    row.Number(joint.longest_high_secs);
    row.Whole(static_cast<long long>(joint.rises));
    row.Number(joint.rises_per_min);
  }

  const std::set<std::string> labels_;
  std::string& out_;
};

}  // namespace

void WriteStudyCsv(const Study& study, const std::string& path) {
  OutputFile out(path);
  Rows rows(study, out.buffer());
  rows.WriteNames();
  for (const StudyTrial& trial : study.trials) {
    rows.Write(trial);
    out.FlushWhenLarge();
  }
  out.Finish();
}

}  // namespace kinescope::app
