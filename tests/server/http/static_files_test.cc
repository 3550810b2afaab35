#include "server/http/static_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "tests/folders.h"
#include "tests/temp_folder.h"

namespace kinescope::http {
namespace {

namespace fs = std::filesystem;
using kinescope::testing::InSourceTree;
using ::testing::ElementsAre;

class StaticFilesTest : public ::testing::Test {
 protected:
  StaticFilesTest() { fs::create_directory(web()); }

  fs::path web() const { return folder_ / "web"; }
  void Write(const fs::path& path, const std::string& text = "x") {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  std::vector<std::string> Listed() const {
    const StaticFiles files(web());
    std::vector<std::string> urls;
    for (const auto& [url, file] : files.all()) urls.push_back(url);
    return urls;
  }

  const kinescope::testing::TempFolder folder_;
};

TEST_F(StaticFilesTest, ListsOnlyThePageAndItsLibraries) {
  for (const char* name :
       {"index.html", "app.js", "style.css", "parts/icon.svg", "package.json", "CMakeLists.txt",
        ".npmrc", ".secret/a.js", "notes.txt", "node_modules/three/build/three.module.js",
        "node_modules/three/build/three.cjs", "node_modules/other/index.js"}) {
    Write(web() / name);
  }
  EXPECT_THAT(Listed(), ElementsAre("/", "/app.js", "/index.html", "/lib/three/three.module.js",
                                    "/parts/icon.svg", "/style.css"));
}

TEST_F(StaticFilesTest, OmitsLinksOutOfTheFolder) {
  Write(folder_ / "secret.js");
  Write(folder_ / "elsewhere/inner.js");
  Write(web() / "app.js");
  fs::create_symlink(folder_ / "secret.js", web() / "out.js");
  fs::create_symlink("../secret.js", web() / "relative_out.js");
  fs::create_directory_symlink(folder_ / "elsewhere", web() / "elsewhere");
  fs::create_symlink("app.js", web() / "inside.js");
  fs::create_symlink("gone.js", web() / "dangling.js");
  fs::create_directory(web() / "folder.js");
  EXPECT_THAT(Listed(), ElementsAre("/app.js", "/inside.js"));
}

TEST_F(StaticFilesTest, ServesTheBundleUnlessAModuleIsNewer) {
  const fs::path bundle = folder_ / "build/app.js";
  Write(bundle);
  for (const char* name : {"index.html", "app.js", "plot.js"}) Write(web() / name);
  const auto served = [&] { return StaticFiles(web(), bundle).Find("/app.js")->path; };
  const auto made = fs::last_write_time(bundle);
  const std::chrono::minutes step(1);
  const auto change_all = [&](auto time) {
    for (const char* name : {"app.js", "plot.js"}) fs::last_write_time(web() / name, time);
  };
  change_all(made - step);
  EXPECT_EQ(served(), bundle);
  change_all(made);  // as in a package
  EXPECT_EQ(served(), bundle);
  fs::last_write_time(web() / "index.html", made + step);
  EXPECT_EQ(served(), bundle) << "it is not in the bundle";
  fs::last_write_time(web() / "plot.js", made + step);
  EXPECT_EQ(served(), fs::canonical(web() / "app.js"));
  fs::remove(bundle);
  EXPECT_EQ(served(), fs::canonical(web() / "app.js"));
}

TEST_F(StaticFilesTest, IsEmptyWithoutAFolder) {
  EXPECT_TRUE(StaticFiles(folder_ / "nowhere").all().empty());
  EXPECT_TRUE(StaticFiles("").all().empty());
}

TEST_F(StaticFilesTest, ChangesTheEntityTagWhenTheFileChanges) {
  Write(web() / "app.js", "one");
  const std::string before = EntityTag(web() / "app.js");
  EXPECT_EQ(EntityTag(web() / "app.js"), before);
  Write(web() / "app.js", "three");
  EXPECT_NE(EntityTag(web() / "app.js"), before);
  EXPECT_EQ(EntityTag(web() / "gone.js"), "");
}

TEST(StaticFilesOfThePage, AreComplete) {
  const StaticFiles files(InSourceTree("web"));
  for (const char* url : {"/", "/index.html", "/app.js", "/style.css", "/favicon.svg"}) {
    EXPECT_NE(files.Find(url), nullptr) << url;
  }
}

TEST(StaticFilesOfThePage, IncludeItsLibraries) {
  if (!fs::exists(InSourceTree("web/node_modules"))) {
    GTEST_SKIP() << "web/node_modules is absent: sh web/fetch_libraries.sh";
  }
  const StaticFiles files(InSourceTree("web"));
  for (const Library& library : Libraries()) {
    EXPECT_NE(files.Find(library.url), nullptr) << library.path << " is not in the npm package";
  }
}

}  // namespace
}  // namespace kinescope::http
