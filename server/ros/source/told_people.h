/// Adds to people what the node of their suit was told about them, beside the motion: as it tells
/// other nodes, and recorders, on kPeopleTopic. The latest counts. Memory is limited; one thread.
#pragma once

#include <kinescope/PersonArray.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/source.h"

namespace kinescope::ros_bridge {

class ToldPeople : public SampleSink {
 public:
  static constexpr std::size_t kMostPeople = 64;

  /// By what a person is known; "": not by that.
  struct Marks {
    std::string pelvis_frame;
    std::string topics;  // name in front of theirs
  };

  explicit ToldPeople(std::function<Marks(int character)> marks_of)
      : marks_of_(std::move(marks_of)) {}

  /// Where people and samples go; not null while some come.
  void SetSink(SampleSink* sink) { sink_ = sink; }

  /// Takes the bytes of a kinescope/PersonArray. False: they are none.
  [[nodiscard]] bool Take(const std::vector<std::uint8_t>& bytes);

  /// Whether something was told of the person whose topics begin with `topics`.
  bool Knows(const std::string& topics) const;

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;

 private:
  struct Told {
    kinescope_ros::Person message;
    std::uint64_t revision = 0;  // increases with every change
  };
  struct Person {
    Character character;         // as the source described it
    std::uint64_t revision = 0;  // of what was passed on; 0: nothing was
    std::uint64_t looked = 0;    // revisions_ when that was looked for
  };

  const Told* Find(int character) const;
  void Give(Person& person);

  const std::function<Marks(int character)> marks_of_;
  SampleSink* sink_ = nullptr;
  kinescope_ros::PersonArray message_;  // reused, keeps its memory
  std::vector<Told> told_;
  std::uint64_t revisions_ = 0;
  std::map<int, Person> people_;  // by character; as many as the source has
};

}  // namespace kinescope::ros_bridge
