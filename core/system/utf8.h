/// Decodes untrusted UTF-8, and encodes. Names in streams and files are untrusted: without this,
/// they could steer a terminal. Pure functions, any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope {

/// The code points of `utf8`; invalid bytes, control characters, line breaks and characters that
/// reverse the text after them become U+FFFD.
std::u32string DecodeUtf8(std::string_view utf8);

/// @pre each is a code point, such as of DecodeUtf8()
std::string EncodeUtf8(std::u32string_view code_points);

/// `text` for one line of a terminal or a log, as DecodeUtf8() reads it.
std::string PrintableLine(std::string_view text);

/// The same for several lines: line feeds and tabs stay.
std::string PrintableLines(std::string_view text);

}  // namespace kinescope
