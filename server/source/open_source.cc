#include "server/source/open_source.h"

#include <filesystem>
#include <utility>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/words.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/mvn/file/recording.h"
#include "server/mvn/tapped_datagrams.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/source/graph_source.h"
#include "server/source/paced_source.h"
#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

void CheckNeedsNoBag(const std::string& url, const SourceSettings& settings) {
  if (settings.bag.is_empty()) return;
  throw SourceError("source '" + url +
                    "': is no ROS bag, so it has neither topics (--marker_topics, --tf_topic) nor "
                    "transforms that move a robot (--robot=FILE@tf)");
}

// Opened once only: it may be a pipe.
std::unique_ptr<Source> OpenFile(const std::string& path, const SourceSettings& settings) {
  std::error_code ignored;
  if (path != "-" && !std::filesystem::exists(path, ignored)) {
    const std::size_t colon = path.find(':');
    throw SourceError("source '" + path + "': file not found; expected " + SourceKinds() +
                      (colon == std::string::npos
                           ? ""
                           : SuggestionFor(path.substr(0, colon + 1), SchemePrefixes())));
  }
  InputFile file = OpenInputFile(path);
  const std::string name = NameOfInput(path);
  const mvn::RecordingKind kind = mvn::KindOf(file.head());
  if (kind != mvn::RecordingKind::kRosBag) CheckNeedsNoBag(path, settings);
  switch (kind) {
    case mvn::RecordingKind::kPcap:
    case mvn::RecordingKind::kDatagrams:
      return mvn::OpenStream(mvn::OpenRecording(std::move(file), name), settings.stream);
    case mvn::RecordingKind::kMvnx: return std::make_unique<mvn::MvnxSource>(std::move(file), name);
    case mvn::RecordingKind::kRosBag:
      if (path == "-")
        throw SourceError("a ROS bag cannot be read from a pipe; save it to a file first");
      return ros_bridge::OpenBag(path, settings.bag);
    case mvn::RecordingKind::kEmpty:
    case mvn::RecordingKind::kUnknown: break;
  }
  throw SourceError(mvn::DescribeUnfit(path, file.head(), SourceKinds()));
}

}  // namespace

Hindrance HindranceOf(const std::string& url, const Source& source) {
  if (!ros_bridge::IsGraphUrl(url)) return {};
  return {ros_bridge::MissingInGraph(source), !ros_bridge::HasMaster(source)};
}

bool IsBag(const std::string& url) {
  std::error_code ignored;
  if (KindOfSource(url) != SourceKind::kFile || !std::filesystem::is_regular_file(url, ignored)) {
    return false;
  }
  return mvn::KindOf(OpenInputFile(url).head()) == mvn::RecordingKind::kRosBag;
}

bool IsOfRos(const std::string& url) {
  return KindOfSource(url) == SourceKind::kGraph || IsBag(url);
}

std::unique_ptr<Source> OpenSource(const std::string& url, const SourceSettings& settings) {
  if (KindOfSource(url) != SourceKind::kFile) CheckNeedsNoBag(url, settings);
  switch (KindOfSource(url)) {
    case SourceKind::kUdp:
    case SourceKind::kTcp:
      return mvn::OpenStream(mvn::Tapped(mvn::OpenDatagrams(url), settings.tap), settings.stream);
    case SourceKind::kGraph: return ros_bridge::OpenGraph(url, settings.bag);
    case SourceKind::kSubject:
      return subject::OpenSubject(WithoutScheme(url), settings.subject_rate_hz, 0,
                                  settings.subject_height_m);
    case SourceKind::kPose:
      return subject::OpenPose(WithoutScheme(url), settings.subject_rate_hz,
                               settings.subject_height_m);
    case SourceKind::kFile: break;
  }
  return OpenFile(url, settings);
}

std::unique_ptr<Source> OpenAtTrueRate(const std::string& url, bool loop,
                                       const SourceSettings& settings, std::int64_t start_at) {
  auto source = OpenSource(url, settings);
  if (source->is_live()) return source;
  if (loop && url == "-") {
    throw UsageError("--loop: standard input cannot be read twice; save it to a file first");
  }
  PacedSource::Open reopen;
  if (loop) reopen = [url, settings] { return OpenSource(url, settings); };
  return std::make_unique<PacedSource>(std::move(source), std::move(reopen), start_at);
}

std::unique_ptr<Source> OpenUpTo(const std::string& url, std::int64_t stop_at,
                                 const SourceSettings& settings) {
  auto source = OpenSource(url, settings);
  KINESCOPE_CHECK(!source->is_live());
  return PacedSource::UpTo(stop_at, std::move(source));
}

}  // namespace kinescope::app
