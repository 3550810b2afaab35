/// The kinds of sources, distinguished by the beginning of their URL. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kinescope::app {

enum class SourceKind { kUdp, kTcp, kGraph, kSubject, kPose, kFile };

/// Never fails: whatever has no scheme is a file.
SourceKind KindOfSource(std::string_view url);

/// Whether samples arrive when they are measured, and the source has no end.
bool IsLiveUrl(std::string_view url);
/// The built-in subject, in motion or in a written pose: samples are generated, and never end.
bool IsSubjectUrl(std::string_view url);
bool IsNetworkUrl(std::string_view url);

/// "udp:", "tcp:", ...
std::vector<std::string> SchemePrefixes();

/// After the scheme: "lift" of "demo:lift".
std::string WithoutScheme(std::string_view url);

/// "udp://[address]:port, ..., demo:MOTION (lift, walk, ...), ...", for --help and errors.
const std::string& SourceKinds();
/// Those with an end or a beginning of their own: the subject and files.
const std::string& RecordedSourceKinds();

// Length that is read of a source without an end unless an option sets it, s.
inline constexpr double kSubjectClipSecs = 10;
inline constexpr double kSubjectLoadsSecs = 8;    // one lift
inline constexpr double kSubjectPrescanSecs = 5;  // for a camera that depends on the whole motion
inline constexpr double kInspectSecs = 5;
// The latest time of it that an option may set, s: everything before is generated, too.
inline constexpr double kSubjectLatestSecs = 3600;

}  // namespace kinescope::app
