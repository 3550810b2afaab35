// What the series of ten minutes cost: four people at 240 Hz.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "server/history/series.h"
#include "server/http/series_json.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::history {
namespace {

constexpr int kPeople = 4;
constexpr std::int64_t kSecs = 600, kRate = 240;

// Each state has a new sample of one person, as those of a live stream.
const SceneState& StateOf(std::int64_t number) {
  static SceneState state = http::testing::MakeScene(1, 0, 1, http::testing::MakePersonModel(), 4);
  state.number = static_cast<std::uint64_t>(number);
  state.made_nanos = number * 1'000'000'000 / (kRate * kPeople);
  BodySample& sample = state.people[static_cast<std::size_t>(number % kPeople)].sample;
  sample.counter = static_cast<std::uint32_t>(number / kPeople);
  sample.stamp_nanos = state.made_nanos;
  return state;
}

const Series& TenMinutes() {
  static const auto series = [] {
    auto made = std::make_unique<Series>();
    for (std::int64_t i = 0; i < kSecs * kRate * kPeople; ++i) made->Add(StateOf(i));
    return made;
  }();
  return *series;
}

void BM_Add(benchmark::State& state) {
  Series series;
  std::int64_t number = 0;
  SceneState next = StateOf(0);
  for (auto _ : state) {
    ++number;
    next.made_nanos = number * 1'000'000;
    next.people[0].sample.stamp_nanos = next.made_nanos;
    series.Add(next);
  }
}
BENCHMARK(BM_Add);

// The first request of a page: `keys` in `columns` over all ten minutes, as JSON.
void BM_AskForAll(benchmark::State& state) {
  const Series& series = TenMinutes();
  SeriesQuestion question;
  for (std::int64_t key = 0; key < state.range(0); ++key) {
    question.keys.push_back(static_cast<std::size_t>(key));
  }
  question.until_nanos = kSecs * 1'000'000'000;
  question.columns = static_cast<std::size_t>(state.range(1));
  std::size_t bytes = 0;
  for (auto _ : state) bytes = http::SeriesJson(question, *series.Ask(question)).size();
  state.counters["answer_bytes"] = static_cast<double>(bytes);
  state.counters["series_bytes"] = static_cast<double>(series.bytes());
}
BENCHMARK(BM_AskForAll)->Args({4, 2400})->Args({12, 400})->Args({24, 833})->Args({4, 4096});

// What a page asks for twice a second.
void BM_AskForTheLastSecond(benchmark::State& state) {
  const Series& series = TenMinutes();
  SeriesQuestion question;
  for (std::size_t key = 0; key < 12; ++key) question.keys.push_back(key);
  question.from_nanos = (kSecs - 1) * 1'000'000'000;
  question.until_nanos = kSecs * 1'000'000'000;
  question.columns = 40;
  for (auto _ : state) {
    benchmark::DoNotOptimize(http::SeriesJson(question, *series.Ask(question)).size());
  }
}
BENCHMARK(BM_AskForTheLastSecond);

}  // namespace
}  // namespace kinescope::history
