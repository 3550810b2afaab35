/// Who changed what, when: each change of an operator is a mark with the old and the new value, at
/// the newest sample unless another is given. Trials are spans. Any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/marks/mark_book.h"

namespace kinescope::app {

/// Role of what is ordered over ROS, in marks.
inline constexpr char kRosRole[] = "ros";

class OperatorLog {
 public:
  /// Both are borrowed; `book` may be null: nothing is kept then.
  OperatorLog(marks::MarkBook* book, const Latest<SceneState>& states)
      : book_(book), states_(states) {}

  /// Marks "what: before → after"; nothing if both are equal. A mark that cannot be kept is logged,
  /// and the change holds all the same.
  void Note(std::string_view role, const std::string& what, const std::string& before,
            const std::string& after) {
    Note(role, what, before, after, Now());
  }
  void Note(std::string_view role, const std::string& what, const std::string& before,
            const std::string& after, const marks::Moment& at);
  /// @return the id of the mark at that moment; nullopt if it was not kept
  std::optional<std::uint64_t> BeginTrial(std::string_view role, const std::string& title,
                                          const marks::Moment& at);
  void EndTrial(std::uint64_t id, const marks::Moment& at);

  /// The newest sample; its state is 0 before the first.
  marks::Moment Now() const;

 private:
  std::optional<std::uint64_t> Add(const marks::NewMark& mark);

  marks::MarkBook* const book_;
  const Latest<SceneState>& states_;
};

}  // namespace kinescope::app
