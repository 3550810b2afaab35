#include "server/marks/mark_book.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "server/marks/mark_json.h"
#include "tests/temp_folder.h"

namespace kinescope::marks {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TempFolder;

Moment At(std::uint64_t state) {
  Moment moment;
  moment.state = state;
  moment.made_nanos = 1'000'000 * static_cast<std::int64_t>(state);
  moment.stamp_nanos = 1'800'000'000'000'000'000 + moment.made_nanos;
  moment.counter = static_cast<std::uint32_t>(state - 1);
  return moment;
}

NewMark Text(const std::string& text, std::uint64_t state = 5) {
  NewMark mark;
  mark.text = text;
  mark.role = "operator";
  mark.at = At(state);
  return mark;
}

NewMark Button(int button, std::uint64_t state = 5) {
  NewMark mark = Text("", state);
  mark.button = button;
  return mark;
}

std::vector<std::string> Lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class MarkBookTest : public ::testing::Test {
 protected:
  MarkBook Open() const { return MarkBook({file_, {"lift", "lower"}}); }
  static std::vector<std::string> TextsOf(const MarkBook& book) {
    std::vector<std::string> texts;
    for (const Mark& mark : book.ChangedAfter(0, 1000)) texts.push_back(mark.text);
    return texts;
  }

  const TempFolder folder_;
  const std::filesystem::path file_ = std::filesystem::path(folder_ / "of" / "the lab.jsonl");
};

TEST_F(MarkBookTest, MakesItsFileWithTheFirstMark) {
  MarkBook book = Open();
  EXPECT_FALSE(std::filesystem::exists(file_.parent_path()));
  const auto mark = book.Add(Button(2));
  ASSERT_TRUE(mark) << mark.error();
  EXPECT_EQ(mark->text, "lower");
  EXPECT_EQ(mark->at.counter, 4U);
  ASSERT_EQ(Lines(file_).size(), 1U);
  const auto line = ReadMark(Lines(file_)[0]);
  ASSERT_TRUE(line);
  EXPECT_EQ(ToJson(*line), ToJson(*mark)) << "what is in the file is what was answered";
}

TEST_F(MarkBookTest, HasItsMarksAgainAfterAStart) {
  {
    MarkBook book = Open();
    ASSERT_TRUE(book.Add(Button(1)));
    ASSERT_TRUE(book.Add(Text("belt slipped")));
    ASSERT_TRUE(book.Remove(1));
  }
  MarkBook book = Open();
  EXPECT_THAT(TextsOf(book), ElementsAre("belt slipped"));
  const auto next = book.Add(Text("next"));
  ASSERT_TRUE(next);
  EXPECT_EQ(next->id, 3U);
  EXPECT_FALSE(book.End(2, At(9))) << "no moment of an earlier start can be compared";
}

TEST_F(MarkBookTest, ASpanIsEndedOnce) {
  MarkBook book = Open();
  NewMark begin = Button(1, 50);
  begin.is_span = true;
  const auto open = book.Add(begin);
  ASSERT_TRUE(open);
  EXPECT_TRUE(open->is_open);
  const auto span = book.End(open->id, At(20));
  ASSERT_TRUE(span);
  EXPECT_EQ(span->at.state, 20U) << "its author looked back in the meantime";
  EXPECT_EQ(span->end->state, 50U);
  EXPECT_FALSE(span->is_open);
  EXPECT_THAT(book.End(open->id, At(60)).error(), HasSubstr("mark 1 is no span that is open"));
  EXPECT_THAT(book.End(77, At(60)).error(), HasSubstr("no mark 77"));
}

TEST_F(MarkBookTest, TellsWhatHasChanged) {
  MarkBook book = Open();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(book.Add(Text(std::to_string(i))));
  const std::uint64_t before = book.revision();
  EXPECT_THAT(book.ChangedAfter(before, 10), IsEmpty());
  ASSERT_TRUE(book.Remove(2));
  const auto changed = book.ChangedAfter(before, 10);
  ASSERT_EQ(changed.size(), 1U);
  EXPECT_EQ(changed[0].id, 2U);
  EXPECT_TRUE(changed[0].is_removed);
  EXPECT_EQ(book.ChangedAfter(0, 3).size(), 3U) << "no more than wanted";
  EXPECT_THAT(TextsOf(book), ElementsAre("0", "2", "3", "4"));
}

TEST_F(MarkBookTest, KeepsWhatAnOperatorChanged) {
  {
    MarkBook book = Open();
    NewMark change = Text("mass of S07: 75 kg → 82 kg");
    change.kind = Kind::kChange;
    const auto kept = book.Add(change);
    ASSERT_TRUE(kept);
    EXPECT_THAT(book.Remove(kept->id).error(),
                HasSubstr("tells what an operator changed; it stays"));
  }
  const MarkBook again = Open();
  ASSERT_EQ(again.ChangedAfter(0, 10).size(), 1U);
  EXPECT_EQ(again.ChangedAfter(0, 10)[0].kind, Kind::kChange);
}

TEST_F(MarkBookTest, ReadsMarksOfVersionsWithoutKinds) {
  nlohmann::json mark = ToJson(*Open().Add(Text("belt")));
  EXPECT_EQ(mark["kind"], "mark");
  mark.erase("kind");
  ASSERT_TRUE(ReadMark(mark.dump()));
  EXPECT_EQ(ReadMark(mark.dump())->kind, Kind::kMark);
  mark["kind"] = "other";
  EXPECT_FALSE(ReadMark(mark.dump()));
}

TEST_F(MarkBookTest, RefusesAnUnknownButton) {
  MarkBook book = Open();
  EXPECT_THAT(book.Add(Button(3)).error(), HasSubstr("button 3: there are 2"));
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(MarkBookTest, LeavesAFileThatIsCutOrForeignAsItIs) {
  std::filesystem::create_directories(file_.parent_path());
  {
    MarkBook book = Open();
    ASSERT_TRUE(book.Add(Text("whole")));
    ASSERT_TRUE(book.Add(Text("cut")));
  }
  const auto lines = Lines(file_);
  std::ofstream(file_) << "no JSON\n" << lines[0] << "\n{\"id\": -1}\n" << lines[1].substr(0, 60);
  MarkBook book = Open();
  EXPECT_THAT(TextsOf(book), ElementsAre("whole"));
  EXPECT_EQ(book.unread_lines(), 3);
  ASSERT_TRUE(book.Add(Text("new")));
  EXPECT_EQ(Lines(file_).size(), 5U);
  EXPECT_TRUE(ReadMark(Lines(file_).back())) << "not at the end of the line that is cut";
}

// The kernel refuses to let a file grow beyond this limit, as a full disk does.
TEST_F(MarkBookTest, KeepsNeitherAMarkNorAPieceOfItIfTheDiskIsFull) {
  MarkBook book = Open();
  ASSERT_TRUE(book.Add(Text("first")));
  const auto size = std::filesystem::file_size(file_);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{size + 20, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &full);
  const auto refused = book.Add(Text("second"));
  const auto not_removed = book.Remove(1);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error(), HasSubstr(file_.string()));
  EXPECT_FALSE(not_removed);
  EXPECT_EQ(std::filesystem::file_size(file_), size);
  EXPECT_THAT(TextsOf(book), ElementsAre("first"));
  ASSERT_TRUE(book.Add(Text("third"))) << "there is room again";
  EXPECT_THAT(TextsOf(book), ElementsAre("first", "third"));
}

TEST_F(MarkBookTest, RefusesAFileOfAnotherServerAndWhatIsNoFile) {
  MarkBook book = Open();
  ASSERT_TRUE(book.Add(Text("first")));
  EXPECT_THROW(Open(), UsageError);
  try {
    MarkBook({file_.parent_path(), {}});
    FAIL() << "a folder";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--marks_file=" + file_.parent_path().string()));
  }
}

TEST(MarkJson, AcceptsNoOtherShape) {
  Mark mark;
  mark.id = 7;
  mark.text = "<b>\"é\"</b>";
  mark.end = At(9);
  const auto whole = ToJson(mark);
  ASSERT_TRUE(ReadMark(whole.dump()));
  EXPECT_EQ(ReadMark(whole.dump())->text, mark.text);
  for (const auto& [name, value] : whole.items()) {
    if (name == "window_stamp_micros") continue;  // made of the others
    auto other = whole;
    other.erase(name);
    const bool may_be_absent = name == "kind";  // in the files of earlier versions
    EXPECT_EQ(ReadMark(other.dump()).has_value(), may_be_absent) << "without " << name;
    other[name] = {1, 2};
    EXPECT_FALSE(ReadMark(other.dump())) << name;
  }
  for (const char* number : {"-1", "18446744073709551615", "1.5", "true"}) {
    auto other = whole;
    other["id"] = nlohmann::json::parse(number);
    EXPECT_FALSE(ReadMark(other.dump())) << number;
  }
}

TEST(MarkBook, TellsOfEachChangeThatIsInTheFile) {
  const TempFolder folder;
  std::vector<std::string> heard;
  MarkBook book({folder.path() / "marks.jsonl", {}}, [&](const Mark& mark) {
    heard.push_back(mark.text + (mark.is_removed ? " removed" : mark.end ? " ended" : ""));
  });
  NewMark span = Text("lift");
  span.is_span = true;
  const auto added = book.Add(span);
  ASSERT_TRUE(added);
  ASSERT_TRUE(book.End(added->id, At(9)));
  EXPECT_FALSE(book.Remove(17));
  ASSERT_TRUE(book.Remove(added->id));
  EXPECT_THAT(heard, ElementsAre("lift", "lift ended", "lift removed"));
}

}  // namespace
}  // namespace kinescope::marks
