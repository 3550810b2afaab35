/// A study: the trials of any number of results and JSON files of loads, with what became of each.
/// Reads files; any thread.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/app/batch/label_pattern.h"
#include "server/app/study/trial_loads.h"

namespace kinescope::app {

struct StudySettings {
  std::vector<std::string> paths;  // results and JSON files of loads
  std::string list;                // of the jobs; "": as the results' name says, if it is there
  LabelPattern labels;             // of trials that have none
  std::string person = "person";   // the label that names the person
  std::string condition = "condition";  // and that of the condition
};

/// A file that belongs to a trial.
struct StudyFile {
  std::string what;  // "report", "clip", "picture", "figure", "record", "CSV", "plots", "loads"
  std::string path;  // absolute
};

/// A person in a recording.
struct StudyTrial {
  std::string id;  // of the job; of a file without one its name
  std::map<std::string, std::string> labels;
  std::string person, condition;  // "": unknown
  std::string state;              // "done", "kept", "failed", "interrupted", "missing"
  std::string reason;             // why there are no loads
  std::vector<StudyFile> files;
  std::string source;  // file name of the recording
  std::map<std::string, std::string> options;
  std::optional<PersonLoads> loads;
};

/// A job without success.
struct StudyFailure {
  std::string id, command, state, reason;
  std::string kind;  // `reason` without what differs from job to job
};

/// An option that is not the same in all trials.
struct StudyDifference {
  std::string option;
  std::map<std::string, std::size_t> trials;  // by value
};

struct Study {
  std::vector<StudyTrial> trials;  // in order of person, condition, id; numbers by their value
  std::vector<StudyFailure> failures;
  std::vector<std::string> faults;              // lines that are wrong, files that cannot be read
  std::vector<StudyDifference> differences;     // in what makes loads comparable
  std::map<std::string, std::size_t> programs;  // trials by version
  std::vector<std::string> sources;             // files that were read
  std::string list;                             // of the jobs; "": unknown
  std::size_t jobs = 0;

  std::size_t with_loads() const;
  /// Each once, numbers by their value ("6 kg" before "14 kg"); "" among them if it is unknown of
  /// some.
  std::vector<std::string> People() const;
  std::vector<std::string> Conditions() const;
};

/// `step` is called for each file of loads, on several threads.
/// @throws UsageError, SourceError if there is nothing to be read.
Study ReadStudy(const StudySettings& settings, const std::function<void(std::size_t all)>& step);

/// Without names of files, numbers and other words that differ from job to job.
std::string KindOfReason(const std::string& reason);

}  // namespace kinescope::app
