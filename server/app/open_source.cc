#include "server/app/open_source.h"

#include <filesystem>

#include "server/app/paced_source.h"
#include "server/core/errors.h"
#include "server/mvn/open.h"
#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

bool StartsWith(const std::string& text, const std::string& prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

}  // namespace

std::unique_ptr<Source> OpenSource(const std::string& url, double subject_rate_hz) {
  if (StartsWith(url, "demo:")) {
    return subject::OpenSubject(url.substr(std::string("demo:").size()), subject_rate_hz, 0);
  }
  if (StartsWith(url, "udp:")) return mvn::OpenUdp(url);
  const std::string extension = std::filesystem::path(url).extension();
  if (extension == ".mvnx") return mvn::OpenMvnx(url);
  throw SourceError("source '" + url +
                    "': expected udp://[address]:port, a file that ends in .mvnx, demo:lift or "
                    "demo:walk");
}

std::unique_ptr<Source> OpenAtTrueRate(const std::string& url, bool loop, double subject_rate_hz) {
  auto source = OpenSource(url, subject_rate_hz);
  if (source->is_live()) return source;
  return std::make_unique<PacedSource>(
      [url, subject_rate_hz] { return OpenSource(url, subject_rate_hz); }, loop);
}

}  // namespace kinescope::app
