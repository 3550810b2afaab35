#include "server/source/source_identity.h"

#include <filesystem>

#include "server/source/scheme.h"
#include "server/subject/pose_text.h"

namespace kinescope::app {

SourceIdentity IdentityOf(const std::string& url) {
  SourceIdentity identity{url, {}, true};
  if (KindOfSource(url) == SourceKind::kPose) {
    identity.name = "pose:" + subject::ParsePose(WithoutScheme(url)).text;  // one line, no blanks
  }
  if (IsSubjectUrl(url)) return identity;
  if (IsLiveUrl(url)) {
    identity.is_repeatable = false;
    return identity;
  }
  std::error_code ignored;
  identity.name = std::filesystem::path(url).filename().string();
  identity.is_repeatable = std::filesystem::is_regular_file(url, ignored);
  if (identity.is_repeatable) identity.digest = DigestOf(url);
  return identity;
}

nlohmann::ordered_json ToJson(const SourceIdentity& source) {
  nlohmann::ordered_json json = {{"name", source.name}};
  if (!source.digest) return json;
  json["sha256"] = source.digest->sha256;
  json["bytes"] = source.digest->bytes;
  return json;
}

}  // namespace kinescope::app
