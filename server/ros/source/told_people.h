/// Adds to people what the node of their suit was told about them, beside the motion: as it tells
/// other nodes, and recorders, on kPeopleTopic. The latest counts. Of a graph, a node that has not
/// been heard for kForgetAfterNanos of the person's samples, by their stamps, does not count any
/// more: a bag may be replayed in slow motion. Memory is limited; one thread.
#pragma once

#include <kinescope/PersonArray.h>

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/source.h"
#include "server/ros/person_messages.h"

namespace kinescope::ros_bridge {

class ToldPeople : public SampleSink {
 public:
  static constexpr std::size_t kMostPeople = 64;
  static constexpr std::int64_t kForgetAfterNanos = 5 * kTellEveryNanos;

  /// By what a person is known; "": not by that.
  struct Key {
    std::string pelvis_frame;
    std::string topics;  // name in front of theirs
  };

  explicit ToldPeople(std::function<Key(int character)> key_of) : key_of_(std::move(key_of)) {}

  /// Where people and samples go; not null while some come.
  void SetSink(SampleSink* sink) { sink_ = sink; }

  /// Takes the bytes of a kinescope/PersonArray. False: they are none.
  [[nodiscard]] bool Take(const std::vector<std::uint8_t>& bytes);
  void Take(const kinescope_ros::PersonArray& message);

  bool is_empty() const { return told_.empty(); }

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;

 private:
  struct Told {
    kinescope_ros::Person message;
    std::uint64_t revision = 0;      // increases with every change
    std::int64_t heard_nanos = 0;    // stamp of the newest sample then, of any person
    std::uint64_t heard_number = 0;  // increases with every message
    bool is_gone = false;            // the node that told it, until it is heard again
  };
  struct Person {
    Character character;         // as the source described it
    std::uint64_t revision = 0;  // of what was passed on; 0: nothing was
    std::uint64_t looked = 0;    // revisions_ when that was looked for
    bool has_something = false;  // in what was passed on
    // Stamps of samples of a graph; 0: none, or of a recording.
    std::int64_t newest_nanos = 0, looked_nanos = 0;
    std::int64_t since_nanos = 0;  // there has been no pause
  };

  const Told* Find(const Person& person);
  void Give(Person& person);
  void Say(const std::string& name, const kinescope_ros::Person* told);

  const std::function<Key(int character)> key_of_;
  SampleSink* sink_ = nullptr;
  kinescope_ros::PersonArray message_;  // reused, keeps its memory
  std::vector<Told> told_;
  std::uint64_t revisions_ = 0, messages_ = 0;
  std::int64_t newest_nanos_ = 0;  // stamp of the newest sample
  int said_ = 0;                   // lines of the log
  std::map<int, Person> people_;   // by character; as many as the source has
};

/// Finds in a bag what was told of people when they came. A recorder may write it just after their
/// first poses, since it hears each topic by itself, or a second after them, when it comes again;
/// what is told of them for the first time later is a change. Memory is limited; one thread.
class ToldWhenTheyCame {
 public:
  /// Up to so long after their first poses.
  static constexpr std::int64_t kJustNanos = kTellEveryNanos + 200 * kNanosPerMilli;

  /// A pose of who is known as `key`, the pelvis' frame or a name in front of topics, was recorded
  /// at `now_nanos`.
  void OnPose(const std::string& key, std::int64_t now_nanos) { came_.try_emplace(key, now_nanos); }
  /// Gives to `people` what the bytes of a kinescope/PersonArray, recorded at `now_nanos`, tell of
  /// those who are in one for the first time and came just before. No message: nothing.
  void Find(const std::vector<std::uint8_t>& bytes, std::int64_t now_nanos, ToldPeople& people);

 private:
  bool CameJustBefore(const std::string& key, std::int64_t now_nanos) const;

  kinescope_ros::PersonArray message_;  // reused, keeps its memory
  std::map<std::string, std::int64_t> came_;
  std::set<std::pair<std::string, std::string>> told_;  // at most ToldPeople::kMostPeople
};

}  // namespace kinescope::ros_bridge
