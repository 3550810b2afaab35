/// The tokens of the page, the operator's and the viewers': each from an option, a file or the
/// environment. Only the last two keep it out of the list of processes.
#pragma once

#include <string>
#include <vector>

namespace kinescope::app {

/// Where a token may be set.
struct TokenNames {
  const char* option;    // without "--"; its file has "_file" after it
  const char* variable;  // environment variable, used if no option sets the token
};
inline constexpr TokenNames kOperatorToken{"token", "KINESCOPE_TOKEN"};
inline constexpr TokenNames kViewerToken{"viewer_token", "KINESCOPE_VIEWER_TOKEN"};

struct PageToken {
  std::string text;                // "": none
  std::string origin;              // as messages name it: "--token_file=FILE"
  std::string how_to_see;          // command that prints it, or ""
  std::vector<std::string> notes;  // for the log
};

/// The value of the option itself.
struct TokenOption {
  std::string text;    // "": not given
  std::string origin;  // "--token", "~token" or "file.yaml:3: token"; "": "--token"
};

/// @param file of --token_file; "": not given. A missing file is made with a random token, readable
///   by this user only.
/// @param variable value of `names.variable`; null: not set
/// @throws UsageError if both options are given, or for a file that can be neither read nor made or
///   that holds no token. No message contains a token.
PageToken FindPageToken(const TokenNames& names, const TokenOption& option, const std::string& file,
                        const char* variable);

/// An empty value of an option that was given is a mistake, such as --token_file "$UNSET", and
/// would leave the page without a token. An empty ROS parameter is none: launch files set every
/// parameter.
/// @param given_as "--token_file", "~token_file" or "file.yaml:3: token_file"; "": not given
/// @throws UsageError if `value` is empty, but given
void CheckTokenIsGiven(const std::string& given_as, const std::string& value);

}  // namespace kinescope::app
