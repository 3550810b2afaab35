#include "server/marks/mark_book.h"

#include <algorithm>
#include <ctime>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/state_folder.h"

namespace kinescope::marks {

MarkBook::MarkBook(BookSettings settings, OnChange on_change)
    : settings_(std::move(settings)),
      on_change_(std::move(on_change)),
      run_micros_(WallNanos() / 1000) {
  std::error_code ignored;
  if (!std::filesystem::exists(settings_.file, ignored)) return;
  const std::string problem = OpenFile();
  if (!problem.empty()) throw UsageError("--marks_file=" + problem);
}

std::string MarkBook::OpenFile() {
  std::vector<Mark> lines;
  auto file = MarkFile::Open(settings_.file, lines);
  if (!file) return file.error();
  file_.emplace(*std::move(file));
  for (Mark& mark : lines) {
    if (marks_.size() >= kMostMarks && marks_.count(mark.id) == 0) break;
    mark.revision = revision_ + 1;
    Store(std::move(mark));
  }
  return "";
}

MarkBook::Result MarkBook::Add(const NewMark& given) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Mark mark;
  if (given.button != 0) {
    if (given.button < 0 || static_cast<std::size_t>(given.button) > settings_.names.size()) {
      return tl::unexpected("button " + std::to_string(given.button) + ": there are " +
                            std::to_string(settings_.names.size()));
    }
    mark.text = settings_.names[static_cast<std::size_t>(given.button) - 1];
  } else {
    mark.text = given.text;
  }
  if (marks_.size() >= kMostMarks) {
    return tl::unexpected("there are " + std::to_string(kMostMarks) +
                          " marks, which is the limit; start the server with another --marks_file");
  }
  mark.id = marks_.empty() ? 1 : marks_.rbegin()->first + 1;
  mark.run_micros = run_micros_;
  mark.kind = given.kind;
  mark.button = given.button;
  mark.role = given.role;
  mark.at = given.at;
  mark.is_open = given.is_span;
  mark.behind_secs = given.behind_secs;
  mark.pressed_nanos = WallNanos();
  return Keep(std::move(mark));
}

MarkBook::Result MarkBook::End(std::uint64_t id, const Moment& at) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = marks_.find(id);
  if (found == marks_.end() || found->second.is_removed) {
    return tl::unexpected("there is no mark " + std::to_string(id));
  }
  Mark mark = found->second;
  if (!mark.is_open || mark.run_micros != run_micros_) {
    return tl::unexpected("mark " + std::to_string(id) + " is no span that is open");
  }
  mark.end = at;
  if (at.made_nanos < mark.at.made_nanos) std::swap(mark.at, *mark.end);
  mark.is_open = false;
  return Keep(std::move(mark));
}

MarkBook::Result MarkBook::Remove(std::uint64_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = marks_.find(id);
  if (found == marks_.end() || found->second.is_removed) {
    return tl::unexpected("there is no mark " + std::to_string(id));
  }
  if (found->second.kind == Kind::kChange) {
    return tl::unexpected("mark " + std::to_string(id) +
                          " tells what an operator changed; it stays");
  }
  Mark mark = found->second;
  mark.is_removed = true;
  mark.is_open = false;
  return Keep(std::move(mark));
}

// Only what is in the file counts.
MarkBook::Result MarkBook::Keep(Mark mark) {
  if (!file_) {
    const std::string problem = OpenFile();
    if (!problem.empty()) return tl::unexpected(problem);
  }
  mark.revision = revision_ + 1;
  const std::string problem = file_->Append(mark);
  if (!problem.empty()) return tl::unexpected(problem);
  if (on_change_) on_change_(mark);
  return Store(std::move(mark));
}

// In the place of the former one of its id. @pre its revision is the next one
const Mark& MarkBook::Store(Mark mark) {
  revision_ = mark.revision;
  const auto before = marks_.find(mark.id);
  if (before != marks_.end()) changes_.erase(before->second.revision);
  changes_[mark.revision] = mark.id;
  return marks_.insert_or_assign(mark.id, std::move(mark)).first->second;
}

std::uint64_t MarkBook::revision() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return revision_;
}

std::vector<Mark> MarkBook::ChangedAfter(std::uint64_t revision, std::size_t most) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<Mark> changed;
  for (auto each = changes_.upper_bound(revision); each != changes_.end() && changed.size() < most;
       ++each) {
    const Mark& mark = marks_.at(each->second);
    if (revision > 0 || !mark.is_removed) changed.push_back(mark);
  }
  return changed;
}

int MarkBook::unread_lines() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return file_ ? file_->unread_lines() : 0;
}

std::filesystem::path DefaultMarkFile() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char name[48];
  std::strftime(name, sizeof name, "marks-%Y%m%dT%H%M%SZ.jsonl", &parts);
  return StateFolder() / name;
}

}  // namespace kinescope::marks
