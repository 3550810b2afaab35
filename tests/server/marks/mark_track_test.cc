#include "server/marks/mark_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "server/marks/mark_file.h"
#include "server/marks/mark_json.h"
#include "tests/temp_folder.h"

namespace kinescope::marks {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TempFolder;

constexpr std::int64_t kDay = 1'800'000'000;  // s
constexpr std::int64_t kNoon = 43'200'000;    // ms

// `secs` after noon of a day, by both clocks.
Moment At(double secs, std::int64_t days = 0) {
  Moment moment;
  moment.made_nanos = static_cast<std::int64_t>(7e9 + secs * 1e9);
  moment.time_code_millis = kNoon + static_cast<std::int64_t>(secs * 1e3);
  moment.stamp_nanos =
      (kDay + 86'400 * days) * 1'000'000'000 + static_cast<std::int64_t>(secs * 1e9);
  return moment;
}

Mark Named(const std::string& text, std::uint64_t id, double secs) {
  Mark mark;
  mark.id = id;
  mark.text = text;
  mark.role = "operator";
  mark.at = At(secs);
  return mark;
}

Mark Span(const std::string& text, std::uint64_t id, double from, double to) {
  Mark mark = Named(text, id, from);
  mark.end = At(to);
  return mark;
}

SceneState SceneAt(double secs, std::int64_t days = 0, bool has_time_of_day = true) {
  const Moment moment = At(secs, days);
  SceneState state;
  state.made_nanos = moment.made_nanos;
  state.time_code_millis = moment.time_code_millis;
  state.stamp_nanos = moment.stamp_nanos;
  state.people.emplace_back();
  state.people.front().sample.has_time_of_day = has_time_of_day;
  return state;
}

std::vector<std::string> Texts(const std::vector<const TrackMark*>& marks) {
  std::vector<std::string> texts;
  for (const TrackMark* const each : marks) texts.push_back(each->mark.text);
  return texts;
}

TEST(MarkTrack, TellsMomentsForTheirWindowAndSpansWhileTheyLast) {
  for (const TrackClock clock : {TrackClock::kServer, TrackClock::kTimeCode, TrackClock::kStamp}) {
    const MarkTrack track({Span("lift", 2, 0.5, 10), Named("slip", 1, 2)}, clock);
    EXPECT_THAT(Texts(track.At(SceneAt(0.4))), IsEmpty());
    EXPECT_THAT(Texts(track.At(SceneAt(0.5))), ElementsAre("lift"));
    EXPECT_THAT(Texts(track.At(SceneAt(2))), ElementsAre("lift", "slip"));
    EXPECT_THAT(Texts(track.At(SceneAt(5))), ElementsAre("lift", "slip"));
    EXPECT_THAT(Texts(track.At(SceneAt(5.1))), ElementsAre("lift"));
    EXPECT_THAT(Texts(track.At(SceneAt(10.1))), IsEmpty());
  }
}

TEST(MarkTrack, HasTheLastLineOfEachMark) {
  Mark removed = Named("error", 1, 1), open = Named("walk", 2, 1), trial = Span("trial", 3, 0, 9);
  open.is_open = true;
  removed.is_removed = true;
  trial.kind = Kind::kTrial;
  const MarkTrack track({Named("error", 1, 1), open, trial, removed, Span("walk", 2, 1, 4)},
                        TrackClock::kTimeCode);
  const auto found = track.Between(SceneAt(0), SceneAt(9));
  ASSERT_THAT(Texts(found), ElementsAre("walk"));
  EXPECT_TRUE(found[0]->is_span());
  EXPECT_DOUBLE_EQ(track.SecsAfter(SceneAt(0.5), found[0]->to_nanos), 3.5);
}

TEST(MarkTrack, MarksOfAnotherTimeAreNotOfThisRecording) {
  const MarkTrack track({Named("slip", 1, 2)}, TrackClock::kTimeCode);
  EXPECT_THAT(track.Between(SceneAt(0), SceneAt(9)), ::testing::SizeIs(1));
  EXPECT_THAT(track.Between(SceneAt(0, 1), SceneAt(9, 1)), IsEmpty());
  EXPECT_THAT(track.Between(SceneAt(0, 1, false), SceneAt(9, 1, false)), ::testing::SizeIs(1))
      << "a recording that does not know its day";
  EXPECT_THAT(track.Between(SceneAt(2.1), SceneAt(9)), IsEmpty());
}

TEST(MarkTrack, FindsMarksByTheirStampsWhereTimeCodesAreOfAnotherClock) {
  SceneState first = SceneAt(0), last = SceneAt(9);
  first.time_code_millis = 0;  // of a bag: since its first sample
  last.time_code_millis = 9'000;
  const MarkTrack track({Named("slip", 1, 2)}, TrackClock::kStamp);
  const auto found = track.Between(first, last);
  ASSERT_THAT(Texts(found), ElementsAre("slip"));
  EXPECT_DOUBLE_EQ(track.SecsAfter(first, found[0]->from_nanos), 2);
}

TEST(ReadMarks, SaysWhatIsWrongWithAFile) {
  const TempFolder folder;
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder.path() / name) << text;
    return folder.path() / name;
  };
  const auto good =
      ReadMarks(write("good.jsonl", ToJson(Named("slip", 1, 2)).dump() + "\nnot a mark\n"));
  ASSERT_TRUE(good);
  EXPECT_EQ(good->size(), 1u);
  EXPECT_TRUE(ReadMarks(write("empty.jsonl", "")));
  EXPECT_THAT(ReadMarks(write("wrong.csv", "a,b\n1,2\n")).error(),
              HasSubstr("none of its 2 lines"));
  EXPECT_THAT(ReadMarks(folder.path()).error(), HasSubstr("it is no file"));
  EXPECT_THAT(ReadMarks(folder.path() / "gone").error(), HasSubstr("No such file"));
}

}  // namespace
}  // namespace kinescope::marks
