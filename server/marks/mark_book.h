/// All marks of a server. They are kept in a file, which exists from the first mark on. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/marks/mark.h"
#include "server/marks/mark_file.h"

namespace kinescope::marks {

inline constexpr int kButtons = 9;
inline constexpr std::size_t kMostMarks = 100'000;

struct BookSettings {
  std::filesystem::path file;
  std::vector<std::string> names;  // of the buttons; at most kButtons
};

/// What a person marks.
struct NewMark {
  int button = 0;        // of BookSettings::names, from 1; 0: `text` says it
  std::string text;      // with a button: ignored
  std::string role;      // of its author
  bool is_span = false;  // `at` is its beginning; End() sets its end
  Moment at;
  double behind_secs = 0;  // by which the author looks back
  Kind kind = Kind::kMark;
};

class MarkBook {
 public:
  using Result = tl::expected<Mark, std::string>;  // or why not, one line

  /// Receives each change, once it is in the file; on the thread that makes it.
  using OnChange = std::function<void(const Mark& mark)>;

  /// Reads the file if it exists. @throws UsageError if it cannot be used.
  explicit MarkBook(BookSettings settings, OnChange on_change = nullptr);

  Result Add(const NewMark& mark);
  /// Ends the open span `id`. An end before its beginning exchanges them.
  Result End(std::uint64_t id, const Moment& at);
  Result Remove(std::uint64_t id);

  /// Grows with every change.
  std::uint64_t revision() const;
  /// Those that changed after `revision`, in the order of their changes, at most `most`. With
  /// those that were removed, unless `revision` is 0.
  std::vector<Mark> ChangedAfter(std::uint64_t revision, std::size_t most) const;

  const std::vector<std::string>& names() const { return settings_.names; }
  const std::filesystem::path& file() const { return settings_.file; }
  std::int64_t run_micros() const { return run_micros_; }
  int unread_lines() const;  // of the file, that are no marks

 private:
  Result Keep(Mark mark);
  const Mark& Store(Mark mark);
  std::string OpenFile();

  const BookSettings settings_;
  const OnChange on_change_;  // may be null
  const std::int64_t run_micros_;
  mutable std::mutex mutex_;
  // Guarded by mutex_:
  std::optional<MarkFile> file_;
  std::map<std::uint64_t, Mark> marks_;             // by id
  std::map<std::uint64_t, std::uint64_t> changes_;  // id by revision, of each mark the last one
  std::uint64_t revision_ = 0;
};

/// Where marks are kept if no option says it: a file of this start in StateFolder().
std::filesystem::path DefaultMarkFile();

}  // namespace kinescope::marks
