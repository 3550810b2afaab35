#include "server/app/golden/golden_review.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/system/sha256.h"
#include "render/image/new_file.h"
#include "server/app/golden/accept_lock.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

fs::path AcceptedPicture(const GoldenSuite& suite, const CaseVerdict& verdict) {
  return suite.PictureOf(verdict.name);
}

// nullopt: there is none.
std::optional<std::string> BytesIfPresent(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

void WriteOrRemove(const fs::path& path, const std::optional<std::string>& content) {
  if (content) return render::WriteNewFile(path, *content);
  fs::remove(path);
}

// If it cannot be written, `picture` gets this content back: the two belong together.
void WriteLockOf(const GoldenSuite& suite, const fs::path& picture,
                 const std::optional<std::string>& content) {
  try {
    suite.WriteLockFile();
  } catch (const std::exception&) {
    WriteOrRemove(picture, content);
    throw;
  }
}

}  // namespace

GoldenReview::GoldenReview(AcceptSettings settings)
    : settings_(std::move(settings)), run_(ReadRun(settings_.run)) {
  for (const CaseVerdict& verdict : run_.verdicts) {
    if (verdict.outcome == Outcome::kSame) continue;
    (verdict.now ? cases_ : others_).push_back(&verdict);
  }
  kept_ = ReadDecisions(settings_.run);
  Refresh();
}

const CaseVerdict* GoldenReview::Find(const std::string& name) const {
  const auto found = std::find_if(cases_.begin(), cases_.end(),
                                  [&](const CaseVerdict* each) { return each->name == name; });
  return found == cases_.end() ? nullptr : *found;
}

Decision GoldenReview::Of(const CaseVerdict& verdict) const {
  if (accepted_.count(verdict.name) != 0) return Decision::kAccepted;
  return DecisionFor(verdict, kept_);
}

std::size_t GoldenReview::Count(Decision decision) const {
  return static_cast<std::size_t>(
      std::count_if(cases_.begin(), cases_.end(),
                    [&](const CaseVerdict* each) { return Of(*each) == decision; }));
}

bool GoldenReview::IsAccepted(const GoldenSuite& suite, const CaseVerdict& verdict) {
  const auto entry = suite.lock.find(verdict.name);
  if (entry == suite.lock.end()) return false;
  const bool is_of_it = entry->second.pixels_sha256 == verdict.now->pixels_sha256 &&
                        ToJson(entry->second) == ToJson(*verdict.now);
  if (!is_of_it) return false;
  std::error_code ignored;
  const fs::path picture = AcceptedPicture(suite, verdict);
  return fs::is_regular_file(picture, ignored) &&
         DigestOf(picture).sha256 == verdict.now->file_sha256;
}

void GoldenReview::Refresh() {
  const GoldenSuite suite = SuiteFor(run_, settings_);
  folder_ = suite.folder;
  pictures_ = suite.folder / suite.pictures;
  accepted_.clear();
  for (const CaseVerdict* each : cases_) {
    if (IsAccepted(suite, *each)) accepted_.insert(each->name);
  }
}

GoldenReview::Before GoldenReview::BeforeOf(const GoldenSuite& suite, const CaseVerdict& verdict) {
  Before before;
  before.picture = BytesIfPresent(AcceptedPicture(suite, verdict));
  const auto entry = suite.lock.find(verdict.name);
  if (entry != suite.lock.end()) before.entry = entry->second;
  return before;
}

void GoldenReview::Accept(const CaseVerdict& verdict) {
  const AcceptLock lock(FolderFor(run_, settings_));
  GoldenSuite suite = SuiteFor(run_, settings_);
  if (IsAccepted(suite, verdict)) {  // by another command; there is nothing to restore
    accepted_.insert(verdict.name);
    return;
  }
  Before before = BeforeOf(suite, verdict);
  TakeCase(verdict, settings_, suite);
  WriteLockOf(suite, AcceptedPicture(suite, verdict), before.picture);
  accepted_.insert(verdict.name);
  restorable_[verdict.name] = std::move(before);
  if (kept_.erase(verdict.name) > 0) WriteDecisions(settings_.run, kept_);
}

void GoldenReview::Decide(Decision decision, const CaseVerdict& verdict) {
  if (Of(verdict) == Decision::kAccepted) Restore(verdict);
  KeptDecisions kept = kept_;
  if (decision != Decision::kUndecided) {
    Keep(decision, verdict, kept);
  } else if (kept.erase(verdict.name) == 0) {
    return;
  }
  WriteDecisions(settings_.run, kept);
  kept_ = std::move(kept);
}

void GoldenReview::Restore(const CaseVerdict& verdict) {
  const AcceptLock lock(FolderFor(run_, settings_));
  GoldenSuite suite = SuiteFor(run_, settings_);
  const fs::path picture = AcceptedPicture(suite, verdict);
  if (!IsAccepted(suite, verdict)) {  // by git or another command
    accepted_.erase(verdict.name);
    restorable_.erase(verdict.name);
    throw std::runtime_error(
        "is not accepted any more: another command has changed it since; run check again");
  }
  const auto before = restorable_.find(verdict.name);
  if (before == restorable_.end()) {
    throw std::runtime_error(
        fmt::format("was accepted before this review began, so only version control can restore "
                    "what it replaced: {} and its part of {}",
                    picture.string(), suite.lock_file().string()));
  }
  if (before->second.entry) {
    suite.lock[verdict.name] = *before->second.entry;
  } else {
    suite.lock.erase(verdict.name);
  }
  const auto taken = BytesIfPresent(picture);
  WriteOrRemove(picture, before->second.picture);
  WriteLockOf(suite, picture, taken);
  accepted_.erase(verdict.name);
  restorable_.erase(before);
}

}  // namespace kinescope::app
