#include "server/body/mesh_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::uintmax_t kSetBytes = 1000;

std::vector<MeshFile> OneFile() { return {{"hand.stl", std::string(kSetBytes, 'x')}}; }

std::string NameOf(int number) { return "body-" + std::to_string(number); }

class MeshCacheTest : public ::testing::Test {
 protected:
  std::shared_ptr<const MeshFiles> Set(const std::string& name, const MeshCache& cache) {
    return cache.Files(name, [this] {
      ++made_;
      return OneFile();
    });
  }
  std::string Read(const std::string& name) const {
    std::ifstream file(folder_ / name / "hand.stl", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // As if it was last used so long ago.
  void Age(const std::string& name, int hours) const {
    fs::last_write_time(folder_ / name / "lock",
                        fs::file_time_type::clock::now() - std::chrono::hours(hours));
  }

  const testing::TempFolder folder_;
  int made_ = 0;
};

TEST_F(MeshCacheTest, WritesNothingBeforeFilesAreRequested) {
  const MeshCache cache(folder_.path());
  const auto files = Set("body-1", cache);
  EXPECT_EQ(cache.FolderOf("body-1"), folder_ / "body-1");
  EXPECT_THAT(folder_.Names(), IsEmpty());
  EXPECT_TRUE(files->Provide());
  EXPECT_EQ(Read("body-1"), std::string(kSetBytes, 'x'));
}

TEST_F(MeshCacheTest, WritesASetOnce) {
  const MeshCache cache(folder_.path()), of_another_process(folder_.path());
  const auto files = Set("body-1", cache);
  EXPECT_TRUE(files->Provide());
  EXPECT_TRUE(files->Provide());
  EXPECT_TRUE(Set("body-1", of_another_process)->Provide());
  EXPECT_EQ(made_, 1);
  EXPECT_THAT(folder_.Names(), ElementsAre("body-1")) << "nothing unfinished is left";
}

TEST_F(MeshCacheTest, WritesASetAgainThatTheUserHasRemoved) {
  const MeshCache cache(folder_.path());
  const auto files = Set("body-1", cache);
  EXPECT_TRUE(files->Provide());
  fs::remove_all(folder_ / "body-1");
  EXPECT_TRUE(files->Provide());
  EXPECT_EQ(Read("body-1").size(), kSetBytes);
}

// A sender whose scale data change with every message.
TEST_F(MeshCacheTest, KeepsItsLimitWithAThousandBodies) {
  const MeshCache cache(folder_.path(), 10 * kSetBytes);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_LE(folder_.Names().size(), 10U);
  EXPECT_THAT(folder_.Names(), Contains(NameOf(999)));
}

TEST_F(MeshCacheTest, RemovesTheLeastRecentlyUsedSetFirst) {
  const MeshCache cache(folder_.path(), 3 * kSetBytes);
  for (int i = 1; i <= 3; ++i) {
    ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
    Age(NameOf(i), 10 - i);
  }
  ASSERT_TRUE(Set("body-1", cache)->Provide()) << "used once more";
  ASSERT_TRUE(Set("body-4", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ElementsAre("body-1", "body-3", "body-4"));
}

TEST_F(MeshCacheTest, KeepsTheMeshesOfACurrentModel) {
  const MeshCache cache(folder_.path(), 2 * kSetBytes);
  auto current = Set("body-current", cache);
  ASSERT_TRUE(current->Provide());
  Age("body-current", 100);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_THAT(folder_.Names(), Contains("body-current"));
  current.reset();
  ASSERT_TRUE(Set("body-last", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ::testing::Not(Contains("body-current"))) << "no longer in use";
}

TEST_F(MeshCacheTest, KeepsTheMeshesThatAnotherProcessUses) {
  int ready[2], done[2];
  ASSERT_EQ(pipe(ready) + pipe(done), 0);
  const pid_t other = fork();
  if (other == 0) {
    const MeshCache cache(folder_.path(), kSetBytes);
    const auto files = Set("body-other", cache);
    char byte = files->Provide() ? 1 : 0;
    Age("body-other", 100);
    const bool told = write(ready[1], &byte, 1) == 1 && read(done[0], &byte, 1) == 1;
    _exit(told ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  ASSERT_EQ(byte, 1);
  const MeshCache cache(folder_.path(), kSetBytes);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(Set(NameOf(i), cache)->Provide());
  EXPECT_THAT(folder_.Names(), Contains("body-other"));
  ASSERT_EQ(write(done[1], &byte, 1), 1);
  int status = 0;
  ASSERT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(status, 0);
  ASSERT_TRUE(Set("body-last", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ElementsAre("body-last")) << "a process that ended uses nothing";
  for (const int end : {ready[0], ready[1], done[0], done[1]}) close(end);
}

TEST_F(MeshCacheTest, RemovesFilesOfEarlierVersionsAndCrashedProcesses) {
  for (const char* left : {"figure-0123", "body-1.new-77-0", "body-2.old-77"}) {
    fs::create_directory(folder_ / left);
    std::ofstream(folder_ / left / "hand.stl") << std::string(kSetBytes, 'x');
    fs::last_write_time(folder_ / left, fs::file_time_type::clock::now() - std::chrono::hours(2));
  }
  std::ofstream(folder_ / "other.txt") << "not a mesh";
  const MeshCache cache(folder_.path(), kSetBytes);
  ASSERT_TRUE(Set("body-3", cache)->Provide());
  EXPECT_THAT(folder_.Names(), ElementsAre("body-3", "other.txt"));
}

TEST_F(MeshCacheTest, IsUsedByManyThreadsAtOnce) {
  const MeshCache cache(folder_.path(), 2 * kSetBytes);
  std::vector<std::thread> threads;
  std::atomic<int> provided{0};
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&cache, &provided, thread] {
      for (int i = 0; i < 50; ++i) {
        const auto files = cache.Files(NameOf((i + thread) % 5), OneFile);
        provided += files->Provide() ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(provided, 200);
}

TEST_F(MeshCacheTest, ReportsFailureIfItCannotWrite) {
  const MeshCache cache(folder_.path());
  std::ofstream(folder_ / "body-1") << "a file where the folder has to be";
  EXPECT_FALSE(Set("body-1", cache)->Provide());
}

TEST_F(MeshCacheTest, UsesTheFolderOfTheUserIfItIsWritable) {
  setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
  EXPECT_NE(MeshCache::OfUser(), nullptr);
  EXPECT_THAT(folder_.Names(), ElementsAre("kinescope"));
  fs::remove(folder_ / "kinescope");
  std::ofstream(folder_ / "kinescope") << "a file where the folder has to be";
  EXPECT_EQ(MeshCache::OfUser(), nullptr);
  unsetenv("XDG_CACHE_HOME");
}

}  // namespace
}  // namespace kinescope::app
