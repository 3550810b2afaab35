#include "server/recording/trial_book.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/temp_folder.h"

namespace kinescope::recording {
namespace {

using ::testing::HasSubstr;
using testing::TempFolder;

Trial MakeTrial(const std::string& stem, std::int64_t started_micros) {
  Trial trial;
  trial.stem = stem;
  trial.person = "S07 <b>";
  trial.condition = "lift \"12 kg\"";
  trial.number = 3;
  trial.run_micros = 5;
  trial.started_micros = started_micros;
  trial.from = {10, 1'000'000'000, 7'000};
  trial.to = {70, 3'500'000'000, 9'000};
  trial.mark = 12;
  trial.has_recording = true;
  trial.options = "mass=80\n";
  return trial;
}

TEST(TrialBook, GoesOnWithTheTrialsOfAnEarlierStart) {
  TempFolder top;
  const Folder folder(top.path(), false);
  TrialBook before(folder);
  EXPECT_TRUE(before.trials().empty());
  ASSERT_EQ(before.Put(MakeTrial("b", 20)), "");
  ASSERT_EQ(before.Put(MakeTrial("a", 30)), "");
  Trial running = MakeTrial("c", 10);
  running.to.reset();
  ASSERT_EQ(before.Put(running), "");
  const TrialBook after(folder);
  ASSERT_EQ(after.trials().size(), 3U);
  EXPECT_EQ(after.trials()[0].stem, "c");
  EXPECT_FALSE(after.trials()[0].to);
  EXPECT_EQ(after.trials()[2].stem, "a");
  const Trial& read = *after.Find("b");
  EXPECT_EQ(read.person, "S07 <b>");
  EXPECT_EQ(read.condition, "lift \"12 kg\"");
  EXPECT_EQ(TitleOf(read), "S07 <b> · lift \"12 kg\" · trial 3");
  EXPECT_EQ(LengthSecs(read), 2.5);
  EXPECT_EQ(read.from.state, 10U);
  EXPECT_EQ(read.mark, 12U);
  EXPECT_TRUE(read.has_recording);
  EXPECT_EQ(read.options, "mass=80\n");
  EXPECT_EQ(TrialText(read), TrialText(MakeTrial("b", 20)));
}

TEST(TrialBook, LeavesOutFilesThatAreNoTrials) {
  TempFolder top;
  const Folder folder(top.path(), false);
  const std::string good = TrialText(MakeTrial("good", 1));
  std::ofstream(top / "good.json") << good;
  std::ofstream(top / "copy.json") << good;  // under another name
  std::ofstream(top / "list.json") << "[1, 2]";
  std::ofstream(top / "broken.json") << good.substr(0, 40);
  std::ofstream(top / "number.json") << R"({"trial": "number", "person": "S", "number": 1e300})";
  std::ofstream(top / "negative.json") << R"({"trial": "negative", "person": "S", "number": -1})";
  std::ofstream(top / "large.json") << std::string(100'000, ' ') << good;
  const TrialBook book(folder);
  ASSERT_EQ(book.trials().size(), 1U);
  EXPECT_EQ(book.trials()[0].stem, "good");
}

TEST(TrialBook, ChangesNothingIfTheFileCannotBeWritten) {
  TempFolder top;
  std::filesystem::create_directory(top / "disk");
  const Folder folder(top / "disk", false);
  TrialBook book(folder);
  std::filesystem::remove(top / "disk");
  EXPECT_THAT(book.Put(MakeTrial("a", 1)), HasSubstr("a.json"));
  EXPECT_TRUE(book.trials().empty());
}

}  // namespace
}  // namespace kinescope::recording
