#include "server/recording/folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/temp_folder.h"

namespace kinescope::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::TempFolder;

void Write(const fs::path& path, const std::string& text = "x") { std::ofstream(path) << text; }

TEST(NamePart, KeepsWhatEveryFileSystemTakes) {
  EXPECT_EQ(NamePart("S07", "p"), "S07");
  EXPECT_EQ(NamePart("box 12.5 kg, left", "p"), "box_12_5_kg_left");
  EXPECT_EQ(NamePart("../../etc/passwd", "p"), "etc_passwd");
  EXPECT_EQ(NamePart("Müller", "p"), "M_ller");
  EXPECT_EQ(NamePart("<b>", "p"), "b");
  for (const char* nothing : {"", "..", "/", " ", "\xff\xfe", "日本"}) {
    EXPECT_EQ(NamePart(nothing, "person"), "person") << nothing;
  }
  EXPECT_EQ(NamePart(std::string(500, 'a'), "p").size(), 40U);
}

TEST(Folder, FindsItsFilesByNameAndNothingElse) {
  TempFolder top;
  fs::create_directories(top / "recordings/inner.pcap");
  const Folder folder(top / "recordings", false);
  Write(top / "secret.pcap");
  Write(folder.path() / "S07_lift_001.pcap");
  Write(folder.path() / ".hidden.pcap");
  Write(folder.path() / "notes.txt");
  Write(folder.path() / "two.dots.pcap");
  fs::create_symlink(top / "secret.pcap", folder.path() / "link.pcap");
  EXPECT_EQ(folder.Find("S07_lift_001.pcap"), folder.path() / "S07_lift_001.pcap");
  for (const std::string name :
       {"", ".", "..", "../secret.pcap", "/etc/passwd", ".hidden.pcap", "notes.txt",
        "two.dots.pcap", "link.pcap", "inner.pcap", "missing.pcap", "S07_lift_001.pcap/",
        "./S07_lift_001.pcap", "S07_lift_001.PCAP", ".pcap"}) {
    EXPECT_FALSE(folder.Find(name)) << name;
  }
  EXPECT_FALSE(folder.Find(std::string("S07_lift_001.pcap\0.mp4", 22)));
  EXPECT_FALSE(folder.Find(std::string(5000, 'a') + ".pcap"));
  const auto files = folder.List(10);
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].name, "S07_lift_001.pcap");
  EXPECT_EQ(files[0].bytes, 1U);
}

TEST(Folder, GivesEachNameOnce) {
  TempFolder top;
  const Folder folder(top.path(), false);
  EXPECT_EQ(folder.FreeStem("S07_lift_001"), "S07_lift_001");
  Write(top / "S07_lift_001.json");
  EXPECT_EQ(folder.FreeStem("S07_lift_001"), "S07_lift_001-2");
  Write(top / "S07_lift_001-2.pcap");
  EXPECT_EQ(folder.FreeStem("S07_lift_001"), "S07_lift_001-3");
}

TEST(Folder, IsMadeOnlyIfItMay) {
  TempFolder top;
  const Folder given(top / "disk", false), own(top / "state/recordings", true);
  EXPECT_THAT(given.Prepare(), HasSubstr("is missing; make it, or connect its disk"));
  EXPECT_FALSE(fs::exists(top / "disk"));
  EXPECT_EQ(own.Prepare(), "");
  EXPECT_TRUE(fs::is_directory(own.path()));
  EXPECT_TRUE(given.free_bytes());
}

}  // namespace
}  // namespace kinescope::recording
