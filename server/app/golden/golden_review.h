/// A review: a decision for each picture of a run that differs, carried out at once. It knows
/// nothing of pages; one thread.
///
/// Undo of an accepted picture restores what was accepted before, picture and entry of
/// `golden.lock`, which stays in memory until then. So it is possible only in the review that has
/// accepted it: a copy in the folder of the run would outlive the command, but such a folder may
/// come from a stranger, and undo would make accepted what no person has seen. After that, version
/// control has it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "server/app/golden/golden_accept.h"
#include "server/app/golden/golden_decisions.h"
#include "server/app/golden/golden_run.h"

namespace kinescope::app {

class GoldenReview {
 public:
  /// Reads run, cases and the decisions of earlier reviews. @throws UsageError if there is no run,
  /// or its cases or decisions cannot be read.
  explicit GoldenReview(AcceptSettings settings);

  const GoldenRun& run() const { return run_; }
  const std::filesystem::path& run_folder() const { return settings_.run; }
  const std::filesystem::path& folder() const { return folder_; }      // of the cases
  const std::filesystem::path& pictures() const { return pictures_; }  // that are accepted

  /// Those that can be decided: drawn and not the same. In the order of the run.
  const std::vector<const CaseVerdict*>& cases() const { return cases_; }
  /// Those that differ or could not be compared, but have no picture to decide about.
  const std::vector<const CaseVerdict*>& others() const { return others_; }
  /// Null: there is none to decide about of this name.
  const CaseVerdict* Find(const std::string& name) const;

  Decision Of(const CaseVerdict& verdict) const;
  std::size_t Count(Decision decision) const;
  /// Looks again which pictures are accepted, by other commands and git, too. @throws as
  /// FindGoldenSuite().
  void Refresh();

  /// Each is one of cases(). @throws std::exception why it is not done; the decision is then as
  /// before.
  void Accept(const CaseVerdict& verdict);
  void Reject(const CaseVerdict& verdict) { Decide(Decision::kRejected, verdict); }
  void Postpone(const CaseVerdict& verdict) { Decide(Decision::kLater, verdict); }
  void Undo(const CaseVerdict& verdict) { Decide(Decision::kUndecided, verdict); }

 private:
  // What was accepted of a case.
  struct Before {
    std::optional<std::string> picture;  // content of the file; nullopt: there was none
    std::optional<AcceptedCase> entry;   // of golden.lock
  };

  static bool IsAccepted(const GoldenSuite& suite, const CaseVerdict& verdict);
  static Before BeforeOf(const GoldenSuite& suite, const CaseVerdict& verdict);
  void Decide(Decision decision, const CaseVerdict& verdict);
  void Restore(const CaseVerdict& verdict);

  const AcceptSettings settings_;
  const GoldenRun run_;
  std::filesystem::path folder_, pictures_;
  std::vector<const CaseVerdict*> cases_, others_;
  KeptDecisions kept_;
  std::set<std::string> accepted_;            // names, as Refresh() has seen them
  std::map<std::string, Before> restorable_;  // by name: accepted in this review
};

}  // namespace kinescope::app
