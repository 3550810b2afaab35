#include "server/source/open_source.h"

#include <filesystem>
#include <utility>

#include "core/errors.h"
#include "core/input_file.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/mvn/file/recording.h"
#include "server/mvn/net/net_url.h"
#include "server/ros/bag_source.h"
#include "server/ros/graph_source.h"
#include "server/source/paced_source.h"
#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

// Opened once only: it may be a pipe.
std::unique_ptr<Source> OpenFile(const std::string& path, const SourceSettings& settings) {
  std::error_code ignored;
  if (path != "-" && !std::filesystem::exists(path, ignored)) {
    throw SourceError("source '" + path + "': no such file; expected " + kSourceKinds);
  }
  InputFile file = OpenInputFile(path);
  const std::string name = NameOfInput(path);
  switch (mvn::KindOf(file.head())) {
    case mvn::RecordingKind::kPcap:
    case mvn::RecordingKind::kDatagrams:
      return mvn::OpenStream(mvn::OpenRecording(std::move(file), name), settings.stream);
    case mvn::RecordingKind::kMvnx: return std::make_unique<mvn::MvnxSource>(std::move(file), name);
    case mvn::RecordingKind::kRosBag:
      if (path == "-") throw SourceError("a ROS bag cannot be read from a pipe; save it first");
      return ros_bridge::OpenBag(path);
    case mvn::RecordingKind::kEmpty:
    case mvn::RecordingKind::kUnknown: break;
  }
  throw SourceError(mvn::DescribeUnfit(path, file.head(), kSourceKinds));
}

}  // namespace

std::unique_ptr<Source> OpenSource(const std::string& url, const SourceSettings& settings) {
  if (url.rfind("demo:", 0) == 0) {
    return subject::OpenSubject(url.substr(std::string("demo:").size()), settings.subject_rate_hz,
                                0);
  }
  if (mvn::IsNetUrl(url)) {
    return mvn::OpenStream(mvn::OpenDatagrams(url), settings.stream);
  }
  if (ros_bridge::IsGraphUrl(url)) return ros_bridge::OpenGraph(url);
  return OpenFile(url, settings);
}

bool IsLiveUrl(const std::string& url) { return mvn::IsNetUrl(url) || ros_bridge::IsGraphUrl(url); }

std::unique_ptr<Source> OpenAtTrueRate(const std::string& url, bool loop,
                                       const SourceSettings& settings) {
  auto source = OpenSource(url, settings);
  if (source->is_live()) return source;
  if (loop && url == "-") {
    throw UsageError("--loop: standard input cannot be read twice; save it as a file");
  }
  PacedSource::Open reopen;
  if (loop) reopen = [url, settings] { return OpenSource(url, settings); };
  return std::make_unique<PacedSource>(std::move(source), std::move(reopen));
}

}  // namespace kinescope::app
