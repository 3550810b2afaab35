#include "server/app/inspect/inspection_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string_view>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/utf8.h"

namespace kinescope::app {
namespace {

using mvn::CharacterKind;
using mvn::CharacterReport;
using mvn::InspectionReport;

std::string Seconds(std::int64_t nanos) {
  return fmt::format("{:.2f} s", static_cast<double>(nanos) * 1e-9);
}

std::string Duration(std::int64_t nanos) {
  const double millis = static_cast<double>(nanos) * 1e-6;
  if (millis >= 1000) return Seconds(nanos);
  return fmt::format("{:.{}f} ms", millis, millis < 10 ? 2 : millis < 100 ? 1 : 0);
}

std::string Bytes(std::uint64_t bytes) {
  if (bytes < 10'000) return fmt::format("{} bytes", bytes);
  if (bytes < 10'000'000) return fmt::format("{:.0f} kB", static_cast<double>(bytes) * 1e-3);
  return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

std::string Count(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

std::string Joined(const std::vector<std::string>& parts) {
  return fmt::format("{}", fmt::join(parts, ", "));
}

// "2026-03-06 14:03:11.250 UTC", to the millisecond.
std::string TimeOfDay(std::int64_t wall_nanos) {
  const std::int64_t seconds = wall_nanos / kNanosPerSecond;
  const std::int64_t millis = wall_nanos % kNanosPerSecond / kNanosPerMilli;
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03d} UTC",
                     fmt::gmtime(static_cast<std::time_t>(seconds)), millis);
}

// One fact: its name in a column of its own, broken where it lists too much for a line.
void Line(std::string& out, std::string_view name, std::string_view value) {
  constexpr std::size_t kWidth = 84;
  while (!value.empty()) {
    std::size_t end = value.size();
    if (end > kWidth) {
      const std::size_t comma = value.rfind(", ", kWidth);
      if (comma != value.npos) end = comma + 2;
    }
    out += fmt::format("  {:<12}{}\n", name, value.substr(0, end));
    value.remove_prefix(end);
    name = "";
  }
}

void Head(const InspectionReport& report, std::string& out) {
  out += PrintableLine(report.source) + "\n";
  Line(out, "format", report.format);
  if (report.begin_wall_nanos != 0) {
    Line(out, "time",
         report.has_arrival_times
             ? fmt::format("{:.2f} s from {}", report.secs, TimeOfDay(report.begin_wall_nanos))
             : fmt::format("{:.2f} s by the sender's clock; the file contains no receive times",
                           report.secs));
  }
  if (report.has_datagrams) {
    Line(out, "datagrams", fmt::format("{}, {}", report.datagrams, Bytes(report.bytes)));
  }
  if (!report.transport) return;
  const mvn::TransportCounters& transport = *report.transport;
  std::vector<std::string> parts;
  if (transport.receive_buffer_bytes > 0) {
    parts.push_back("receive buffer " +
                    Bytes(static_cast<std::uint64_t>(transport.receive_buffer_bytes)));
    if (transport.connections == 0) {  // TCP drops nothing
      parts.push_back(fmt::format("{} dropped by the kernel", transport.kernel_drops));
    }
  }
  if (transport.connections > 0) {
    parts.push_back(fmt::format("{}, {} open, {} lost",
                                Count(transport.connections, "connection", "connections"),
                                transport.connections_open, transport.connections_lost));
  }
  if (transport.resyncs > 0) {
    parts.push_back(fmt::format("resynchronised {}, {} skipped",
                                Count(transport.resyncs, "time", "times"),
                                Bytes(transport.skipped_bytes)));
  }
  if (transport.other_packets > 0) {
    parts.push_back(Count(transport.other_packets, "other packet", "other packets"));
  }
  if (transport.incomplete_packets > 0) {
    parts.push_back(Count(transport.incomplete_packets, "packet", "packets") + " truncated");
  }
  Line(out, "transport", Joined(parts));
}

std::string KindTitle(CharacterKind kind) {
  switch (kind) {
    case CharacterKind::kPerson: return "Person";
    case CharacterKind::kObjects: return "Objects";
    case CharacterKind::kUnknown: break;
  }
  return "Character";
}

std::string Segments(const CharacterReport& character) {
  std::vector<std::string> parts;
  if (character.body_segments > 0) parts.push_back(fmt::format("{} body", character.body_segments));
  if (character.left_fingers > 0) {
    parts.push_back(fmt::format("{} left glove", character.left_fingers));
  }
  if (character.right_fingers > 0) {
    parts.push_back(fmt::format("{} right glove", character.right_fingers));
  }
  if (character.props > 0)
    parts.push_back(Count(static_cast<std::uint64_t>(character.props), "prop", "props"));
  if (character.objects > 0) {
    parts.push_back(Count(static_cast<std::uint64_t>(character.objects), "object", "objects"));
  }
  std::string text = Joined(parts);
  if (!character.names.empty()) text += ": " + PrintableLine(Joined(character.names));
  return text;
}

std::string Frames(const CharacterReport& character) {
  if (!character.first_counter) return "none";
  std::string text = fmt::format("{}, counter {} to {}", character.frames, *character.first_counter,
                                 *character.last_counter);
  if (!character.lost) {
    return text + fmt::format(" by {} to {}: too irregular to count lost frames",
                              character.smallest_step, character.largest_step);
  }
  if (character.usual_step != 1) text += fmt::format(" by {:.3g}", character.usual_step);
  return text + fmt::format("; {} lost", *character.lost);
}

std::string Rates(const CharacterReport& character) {
  std::vector<std::string> parts;
  if (character.rate_hz > 0) parts.push_back(fmt::format("{:.2f} Hz", character.rate_hz));
  if (character.capture_rate_hz > 0) {
    parts.push_back(fmt::format("acquisition rate {:.2f} Hz", character.capture_rate_hz));
  }
  return Joined(parts);
}

std::string Samples(const CharacterReport& character, bool has_datagrams) {
  std::vector<std::string> parts = {fmt::format("{}", character.samples)};
  const auto add = [&](std::uint64_t count, const std::string& what) {
    if (count > 0) parts.push_back(fmt::format("{} {}", count, what));
  };
  add(character.incomplete, "incomplete");
  add(character.restarts, character.restarts == 1 ? "restart" : "restarts");
  if (has_datagrams) {
    add(character.duplicates, "duplicate datagrams");
    add(character.late, "late datagrams");
    add(character.outliers, "outliers");
    add(character.mismatched_ids, "items with mismatched id (identified by position)");
  }
  return Joined(parts);
}

void Types(const CharacterReport& character, std::string& out) {
  if (character.types.empty()) return;
  std::size_t width = 0;
  for (const auto& type : character.types) {
    width = std::max(width, mvn::DialogName(type.type).size());
  }
  out += fmt::format("\n  type {:<{}}  {:>8} {:>8} {:>7} {:>7} {:>8}\n", "", width, "count",
                     "per s", "bytes", "items", "in frames");
  for (const auto& type : character.types) {
    const std::string rate = type.rate_hz > 0 ? fmt::format("{:.1f}", type.rate_hz) : "";
    const std::string items = type.fewest_items == type.most_items
                                  ? fmt::format("{}", type.most_items)
                                  : fmt::format("{}-{}", type.fewest_items, type.most_items);
    const std::string share =
        type.share ? fmt::format("{:.1f} %", 100 * std::min(*type.share, 1.0)) : "";
    out += fmt::format("  {:02d}   {:<{}}  {:>8} {:>8} {:>7} {:>7} {:>9}\n", type.type,
                       mvn::DialogName(type.type), width, type.datagrams, rate,
                       type.bytes / type.datagrams, items, share);
  }
}

void Person(const CharacterReport& character, const InspectionReport& report, std::string& out) {
  out += fmt::format("\n{} {}", KindTitle(character.kind), character.id);
  if (!character.name.empty()) out += fmt::format(" '{}'", PrintableLine(character.name));
  if (!character.sender.empty()) out += " from " + character.sender;
  out += "\n";
  if (character.color_rgb) Line(out, "colour", fmt::format("#{:06x}", *character.color_rgb));
  if (character.height_m) Line(out, "height", fmt::format("{:.3f} m", *character.height_m));
  if (character.floor) {
    Line(out, "floor",
         character.floor->why_not.empty() ? fmt::format("z = {:.3f} m", character.floor->height_m)
                                          : "not found: " + character.floor->why_not);
  }
  Line(out, "segments", Segments(character));
  Line(out, "frames", Frames(character));
  Line(out, "rate", Rates(character));
  Line(out, "samples", Samples(character, report.has_datagrams));
  if (character.delays) {
    Line(out, "jitter",
         fmt::format("median {}, 95 % {}, 99 % {}, longest {}", Duration(character.delays->median),
                     Duration(character.delays->p95), Duration(character.delays->p99),
                     Duration(character.delays->longest)));
  }
  // Without a network a gap of one period is no news.
  const double period_nanos = character.rate_hz > 0 ? 1e9 / character.rate_hz : 0;
  const double least = report.has_datagrams ? 0 : 1.5 * period_nanos;
  if (static_cast<double>(character.longest_silence_nanos) > least) {
    Line(out, "silence",
         fmt::format("longest {}, at {}", Duration(character.longest_silence_nanos),
                     Seconds(character.longest_silence_at_nanos)));
  }
  std::vector<std::string> quantities;
  for (const auto& [name, samples] : character.quantities) {
    quantities.push_back(samples == character.samples ? name
                                                      : fmt::format("{} ({})", name, samples));
  }
  Line(out, "also has", Joined(quantities));
  Types(character, out);
  if (!character.advice.empty()) out += "\n";
  for (const std::string& advice : character.advice) out += "  > " + advice + "\n";
}

void Errors(const InspectionReport& report, std::string& out) {
  if (!report.errors.empty()) out += "\nNot used\n";
  for (const mvn::ErrorReport& error : report.errors) {
    out += fmt::format("  {:>8}  {}\n", error.count, PrintableLine(error.reason));
    if (!report.has_datagrams) continue;
    std::string first = fmt::format("first at {}", Seconds(error.at_nanos));
    if (!error.sender.empty()) first += ", from " + error.sender;
    if (error.where) {
      first += fmt::format(", byte {}, value {}", error.where->offset, error.where->value);
    }
    out += fmt::format("  {:>8}  {}\n", "", first);
  }
  if (report.datagrams_not_kept > 0) {
    out += fmt::format(
        "  {:>8}  datagrams of further characters (limit {}) or of characters seen only once\n",
        report.datagrams_not_kept, mvn::Inspection::kMaxCharacters);
  }
  if (!report.ignored.empty()) out += "\nNot needed\n";
  for (const auto& [what, count] : report.ignored) {
    out += fmt::format("  {:>8}  {}\n", count, PrintableLine(what));
  }
}

// Columns that are empty at a line's end leave blanks.
std::string WithoutTrailingBlanks(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\n') out.erase(out.find_last_not_of(' ') + 1);
    out += c;
  }
  return out;
}

}  // namespace

std::string ReportText(const InspectionReport& report) {
  std::string out;
  Head(report, out);
  for (const CharacterReport& character : report.characters) Person(character, report, out);
  Errors(report, out);
  if (!report.advice.empty()) out += "\n";
  for (const std::string& advice : report.advice) out += "> " + advice + "\n";
  if (!report.CanBeShown()) out += "\nNo person or object to show.\n";
  return WithoutTrailingBlanks(out);
}

}  // namespace kinescope::app
