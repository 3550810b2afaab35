// Files that are whole or not there.
#include "render/image/new_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <stdexcept>

#include "tests/full_disk.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ReadFile;
using testing::TempFolder;

void WriteText(NewFile& file, const std::string& text) { file.Write(text.data(), text.size()); }

template <class Action>
std::string NewFileError(Action&& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(NewFile, GetsItsNameOnlyWhenComplete) {
  const TempFolder folder;
  NewFile file(folder / "a.txt");
  WriteText(file, "first ");
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  WriteText(file, "second");
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  file.Commit();
  EXPECT_EQ(ReadFile(folder / "a.txt"), "first second");
  EXPECT_THAT(folder.Names(), ElementsAre("a.txt"));
}

TEST(NewFile, LeavesNothingBehindWithoutCommit) {
  const TempFolder folder;
  {
    NewFile file(folder / "a.txt");
    WriteText(file, "half");
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(NewFile, KeepsTheOldFileUntilTheNewOneIsComplete) {
  const TempFolder folder;
  std::ofstream(folder / "a.txt") << "before";
  {
    NewFile given_up(folder / "a.txt");
    WriteText(given_up, "half");
  }
  EXPECT_EQ(ReadFile(folder / "a.txt"), "before");
  NewFile file(folder / "a.txt");
  WriteText(file, "after");
  EXPECT_EQ(ReadFile(folder / "a.txt"), "before");
  file.Commit();
  EXPECT_EQ(ReadFile(folder / "a.txt"), "after");
  EXPECT_THAT(folder.Names(), ElementsAre("a.txt"));
}

// Root could put a file in the place of /dev/null, and everything on the machine would miss it.
TEST(NewFile, DoesNotReplaceADeviceOrAPipe) {
  const TempFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(NewFileError([&] { NewFile file(pipe); }),
              AllOf(HasSubstr("cannot write " + pipe), HasSubstr("no regular file")));
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_THAT(NewFileError([] { NewFile file("/dev/null"); }), HasSubstr("no regular file"));
}

// Whoever has the old file open goes on reading the old file.
TEST(NewFile, LeavesTheContentOfAnOpenOldFileUnchanged) {
  const TempFolder folder;
  std::ofstream(folder / "a.txt") << "before";
  std::ifstream reader(folder / "a.txt");
  NewFile file(folder / "a.txt");
  WriteText(file, "after");
  file.Commit();
  std::string seen;
  reader >> seen;
  EXPECT_EQ(seen, "before");
}

TEST(NewFile, IsSeparateFromAnotherNewFileOfTheSameName) {
  const TempFolder folder;
  NewFile first(folder / "a.txt"), second(folder / "a.txt");
  WriteText(first, "first");
  WriteText(second, "second");
  first.Commit();
  EXPECT_EQ(ReadFile(folder / "a.txt"), "first");
  second.Commit();
  EXPECT_EQ(ReadFile(folder / "a.txt"), "second");
  EXPECT_THAT(folder.Names(), ElementsAre("a.txt"));
}

TEST(NewFile, CanBeWrittenAndReadByLibrariesBeforeItHasItsName) {
  const TempFolder folder;
  NewFile file(folder / "a.txt");
  std::ofstream(file.open_path()) << "by a library";
  EXPECT_EQ(ReadFile(file.open_path()), "by a library");
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  file.Commit();
  EXPECT_EQ(ReadFile(folder / "a.txt"), "by a library");
}

TEST(NewFile, HasThePermissionsThatTheUmaskAllows) {
  const TempFolder folder;
  const mode_t before = umask(027);
  {
    NewFile file(folder / "a.txt");
    file.Commit();
  }
  umask(before);
  EXPECT_EQ(fs::status(folder / "a.txt").permissions(), fs::perms(0640));
}

TEST(NewFile, NamesAnInvalidTargetAndTheReason) {
  const TempFolder folder;
  std::ofstream(folder / "file") << "not a folder";
  fs::create_directory(folder / "sub");
  const auto error_of = [](const fs::path& path) {
    return NewFileError([&] { NewFile file(path); });
  };
  EXPECT_THAT(error_of("/nowhere/at/all.txt"),
              AllOf(HasSubstr("/nowhere/at/all.txt"), EndsWith("No such file or directory")));
  EXPECT_THAT(error_of(folder / "file" / "a.txt"),
              AllOf(HasSubstr((folder / "file/a.txt").string()), EndsWith("Not a directory")));
  for (const fs::path& path : {folder / "sub", folder / "sub/", fs::path("")}) {
    EXPECT_THAT(error_of(path), AllOf(HasSubstr(path.string()), EndsWith("Is a directory")));
  }
  EXPECT_THAT(folder.Names(), ElementsAre("file", "sub"));
}

TEST(NewFile, NamesTheTargetWhenTheDiskIsFull) {
  const TempFolder folder;
  {
    const testing::SmallFilesOnly full(10);
    EXPECT_THAT(NewFileError([&] {
                  NewFile file(folder / "a.txt");
                  WriteText(file, "more than ten characters");
                }),
                AllOf(HasSubstr((folder / "a.txt").string()), EndsWith("File too large")));
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(NewFile, NamesTheTargetWhenItsFolderWasRemoved) {
  const TempFolder folder;
  fs::create_directory(folder / "sub");
  NewFile file(folder / "sub" / "a.txt");
  fs::remove_all(folder / "sub");
  EXPECT_THAT(NewFileError([&] { file.Commit(); }),
              AllOf(HasSubstr("sub/a.txt"), EndsWith("No such file or directory")));
}

TEST(NewFile, IsInTheCurrentFolderIfItsNameHasNoFolder) {
  const TempFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  NewFile file("a.txt");
  WriteText(file, "here");
  file.Commit();
  fs::current_path(before);
  EXPECT_EQ(ReadFile(folder / "a.txt"), "here");
}

}  // namespace
}  // namespace kinescope::render
