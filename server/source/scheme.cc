#include "server/source/scheme.h"

#include <array>

#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

struct Scheme {
  SourceKind kind;
  std::string_view prefix;
  bool is_live;
  const char* help;
};

constexpr std::array<Scheme, 6> kSchemes = {{
    {SourceKind::kUdp, "udp:", true, "udp://[address]:port"},
    {SourceKind::kTcp, "tcp:", true, "tcp://[address]:port"},
    {SourceKind::kGraph, "ros:", true, "ros: or ros:/topic"},
    {SourceKind::kSubject, "demo:", false, "demo:MOTION"},
    {SourceKind::kPose, "pose:", false, "pose:ANGLES (such as pose:right_elbow=90,left_knee=45)"},
    {SourceKind::kFile, "", false,
     "a recording (MVNX, pcap, pcapng, .bin or ROS bag, also packed with gzip or xz; - for "
     "standard input)"},
}};

const Scheme& SchemeOf(std::string_view url) {
  for (const Scheme& scheme : kSchemes) {
    if (url.substr(0, scheme.prefix.size()) == scheme.prefix) return scheme;
  }
  return kSchemes.back();
}

std::string Kinds(bool with_live) {
  std::string text;
  for (const Scheme& scheme : kSchemes) {
    if (scheme.is_live && !with_live) continue;
    const bool is_last = scheme.kind == kSchemes.back().kind;
    text += (text.empty() ? "" : is_last ? " or " : ", ") + std::string(scheme.help);
    if (scheme.kind != SourceKind::kSubject) continue;
    std::string motions;
    for (const std::string& name : subject::MotionNames()) {
      motions += (motions.empty() ? "" : ", ") + name;
    }
    text += " (" + motions + ")";
  }
  return text;
}

}  // namespace

SourceKind KindOfSource(std::string_view url) { return SchemeOf(url).kind; }

bool IsLiveUrl(std::string_view url) { return SchemeOf(url).is_live; }

bool IsSubjectUrl(std::string_view url) {
  const SourceKind kind = KindOfSource(url);
  return kind == SourceKind::kSubject || kind == SourceKind::kPose;
}

bool IsNetworkUrl(std::string_view url) {
  const SourceKind kind = KindOfSource(url);
  return kind == SourceKind::kUdp || kind == SourceKind::kTcp;
}

std::string WithoutScheme(std::string_view url) {
  return std::string(url.substr(SchemeOf(url).prefix.size()));
}

std::vector<std::string> SchemePrefixes() {
  std::vector<std::string> prefixes;
  for (const Scheme& scheme : kSchemes) {
    if (!scheme.prefix.empty()) prefixes.emplace_back(scheme.prefix);
  }
  return prefixes;
}

const std::string& SourceKinds() {
  static const std::string kinds = Kinds(true);
  return kinds;
}

const std::string& RecordedSourceKinds() {
  static const std::string kinds = Kinds(false);
  return kinds;
}

}  // namespace kinescope::app
