// Ways to spoil the example machine file, each with the exact messages that must follow. Numbers: postproc checklist of
// bad inputs (machines 69 to 78, values 1 to 36, files 37 to 51).
#pragma once

#include <string>

namespace toothpath::test {

struct BadFile {
  const char* what;
  const char* from;  ///< text of the example
  const char* to;
  const char* messages;
};

inline constexpr BadFile kBadMachineFiles[] = {
    {"tool setter without a place", "[chain]", "[tool_check]\ntolerance = 0.05\n\n[chain]",
     "m.toml:17:1: error: tool_check.position is missing\n"},
    {"tool setter with two numbers", "[chain]", "[tool_check]\nposition = [1.0, 2.0]\n\n[chain]",
     "m.toml:18:12: error: tool_check.position has 2 numbers, must have 3\n"},
    {"tool setter without clearance", "[chain]",
     "[tool_check]\nposition = [1.0, 2.0, -390.0]\nclearance = 0\n\n[chain]",
     "m.toml:19:13: error: tool_check.clearance = 0 is below 0.1 mm\n"},
    {"check of a tool without lines", "[chain]", "[tool_check]\nposition = [1.0, 2.0, -390.0]\nlines = []\n\n[chain]",
     "m.toml:19:9: error: tool_check.lines is empty, must have at least one line\n"},
    {"69 limits reversed", "min = -110.0\nmax = 30.0", "min = 30.0\nmax = -110.0",
     "m.toml:41:7: error: axes.A.max = -110 must exceed axes.A.min = 30\n"},
    {"69 limits equal", "max = 0.0", "max = -400.0",
     "m.toml:33:7: error: axes.Z.max = -400 must exceed axes.Z.min = -400\n"},
    {"70 parallel rotary axes", "direction = [1.0, 0.0, 0.0]", "direction = [0.0, 0.0, -1.0]",
     "m.toml:37:13: error: rotary axes C and A are parallel: the angle between them is 0.000000 deg, must be above "
     "0.000057 deg\n"},
    {"71 zero direction", "direction = [1.0, 0.0, 0.0]", "direction = [0.0, 0.0, 0.0]",
     "m.toml:37:13: error: axes.A.direction = [0, 0, 0] has length 0, must be at least 0.001\n"},
    {"72 two axes same letter", "[\"C\", \"A\"]", "[\"C\", \"C\"]",
     "m.toml:18:15: error: axis C is in the chain twice\n"
     "m.toml:36:7: error: axes.A is named in neither chain.table nor chain.head\n"},
    {"72 same letter in table and head", "head = []", "head = [\"C\"]",
     "m.toml:19:9: error: axis C is in the chain twice\n"},
    {"72 same table twice", "[axes.C]", "[axes.A]",
     "m.toml:44:1: error: Error while parsing table header: cannot redefine existing table 'axes.A'\n"},
    {"73 zero speed of a rotary axis", "max_speed = 6000", "max_speed = 0",
     "m.toml:42:13: error: axes.A.max_speed = 0 is below 1 deg/min\n"},
    {"73 zero speed of a linear axis", "max_speed = 20000", "max_speed = 0.0",
     "m.toml:34:13: error: axes.Z.max_speed = 0 is below 1 mm/min\n"},
    {"an axis so slow that no control has a word for its F", "max_speed = 20000", "max_speed = 1e-5",
     "m.toml:34:13: error: axes.Z.max_speed = 1e-05 is below 1 mm/min\n"},
    {"73 negative spindle speed", "max_speed = 24000", "max_speed = -24000",
     "m.toml:10:13: error: spindle.max_speed = -24000 must be above 0 1/min\n"},
    {"74 second rotary turns about the spindle", "[\"C\", \"A\"]", "[\"A\", \"C\"]",
     "m.toml:45:13: error: rotary axis C is parallel to the spindle and cannot tilt the tool: its angle to Z is "
     "0.000000 deg, must be above 0.000057 deg\n"},
    {"an axis that rolls over has no ends", "max = 30.0", "max = 30.0\nrollover = true",
     "m.toml:40:7: error: axes.A.min of an axis with rollover = true, which turns without end: leave min out, or "
     "rollover\n"
     "m.toml:41:7: error: axes.A.max of an axis with rollover = true, which turns without end: leave max out, or "
     "rollover\n"},
    {"rollover is no number", "max = 30.0", "max = 30.0\nrollover = 360",
     "m.toml:42:12: error: axes.A.rollover must be true or false, is a whole number\n"},
    {"74 range smaller than its margins", "max = 30.0", "max = -109.99",
     "m.toml:41:7: error: axes.A.max - axes.A.min = 0.01 deg leaves nothing between the margins of 0.01 deg\n"},
    {"75 sign 0", "sign = 1", "sign = 0", "m.toml:39:8: error: axes.A.sign = 0 must be 1 or -1\n"},
    {"75 sign 2", "sign = 1", "sign = 2", "m.toml:39:8: error: axes.A.sign = 2 must be 1 or -1\n"},
    {"75 sign missing", "sign = 1\n", "", "m.toml:36:1: error: axes.A.sign is missing\n"},
    {"75 sign 1.0", "sign = 1", "sign = 1.0", "m.toml:39:8: error: axes.A.sign must be 1 or -1, is a number\n"},
    {"77 three rotary axes", "head = []", "head = [\"B\"]",
     "m.toml:19:9: error: axis B is rotary axis number 3, a chain has at most 2\n"},
    {"77 control interpolates no path", "max_simultaneous_axes = 5", "max_simultaneous_axes = 2",
     "m.toml:7:25: error: max_simultaneous_axes = 2 is outside 3 to 9\n"},
    {"78 travel in metres", "min = -300.0\nmax = 300.0", "min = -0.3\nmax = 0.3",
     "m.toml:23:7: error: axes.X.max - axes.X.min = 0.6 mm of travel is below 10 mm; lengths are in mm, not metres\n"},
    {"78 table offset in metres", "point = [0.0, 0.0, -285.0]", "point = [0.0, 0.0, -0.285]",
     "m.toml:38:9: error: axes.A.point = [0, 0, -0.285]: the largest offset of the rotary axes, 0.285 mm, is below 1 "
     "mm; lengths are in mm, not metres. If it is in mm, name another point of that axis: [100, 0, -0.285]\n"},
    {"69 infinite travel", "min = -300.0\nmax = 300.0", "min = -300.0\nmax = inf",
     "m.toml:23:7: error: axes.X.max = inf must be finite\n"},
    {"70 almost parallel rotary axes", "direction = [1.0, 0.0, 0.0]", "direction = [0.0, 0.0000005, 1.0]",
     "m.toml:37:13: error: rotary axes C and A are parallel: the angle between them is 0.000029 deg, must be above "
     "0.000057 deg\n"},
    {"71 direction that is not a number", "direction = [1.0, 0.0, 0.0]", "direction = [nan, 0.0, 0.0]",
     "m.toml:37:14: error: axes.A.direction[0] = nan must be finite\n"},
    {"71 direction of 1e-9", "direction = [1.0, 0.0, 0.0]", "direction = [1e-9, 0.0, 0.0]",
     "m.toml:37:13: error: axes.A.direction = [1e-09, 0, 0] has length 1e-09, must be at least 0.001\n"},
    {"73 speed that is not a number", "max_speed = 12000", "max_speed = nan",
     "m.toml:50:13: error: axes.C.max_speed = nan must be finite\n"},
    {"73 zero cutting feed", "cutting_feed = 10000", "cutting_feed = 0",
     "m.toml:13:16: error: limits.cutting_feed = 0 must be above 0 mm/min\n"},
    {"76 no part fits a table of zero", "table_diameter = 500", "table_diameter = 0",
     "m.toml:14:18: error: limits.table_diameter = 0 must be above 0 mm\n"},
    {"1 NaN", "-285.0", "nan", "m.toml:38:20: error: axes.A.point[2] = nan must be finite\n"},
    {"2 Inf", "max = 36000.0", "max = inf", "m.toml:49:7: error: axes.C.max = inf must be finite\n"},
    {"4 1e400", "max = 36000.0", "max = 1e400",
     "m.toml:49:12: error: Error while parsing floating-point: '1e400' could not be interpreted as a value\n"},
    {"6 comma decimal", "max = 36000.0", "max = 36000,0",
     "m.toml:49:7: error: 36000,0 has a decimal comma; write a decimal point: 36000.0\n"},
    {"8 int overflow", "max = 36000.0", "max = 9223372036854775808",
     "m.toml:49:26: error: Error while parsing decimal integer: '9223372036854775808' is not representable in 64 "
     "bits\n"},
    {"9 wrong type", "max = 36000.0", "max = \"36000\"",
     "m.toml:49:7: error: axes.C.max must be a number, is a text\n"},
    {"9 date", "max = 36000.0", "max = 2020-01-01",
     "m.toml:49:7: error: axes.C.max must be a number, is a date or time\n"},
    {"10 missing key", "table_diameter = 500\n", "", "m.toml:12:1: error: limits.table_diameter is missing\n"},
    {"10 missing axis", "[axes.A]", "[axes.B]",
     "m.toml:21:1: error: axes.A is missing\n"
     "m.toml:36:7: error: axes.B is named in neither chain.table nor chain.head\n"},
    {"11 unknown key", "min_block_ms", "min_block_sm",
     "m.toml:12:1: error: limits.min_block_ms is missing\n"
     "m.toml:15:1: error: unknown key limits.min_block_sm; did you mean min_block_ms?\n"},
    {"a feed that is never too quick", "min_block_ms = 1.0", "min_block_ms = 1.0\nfeed_factor = 0.5",
     "m.toml:16:15: error: limits.feed_factor = 0.5 is below 1\n"},
    {"11 unknown table", "[spindle]", "[spindel]",
     "m.toml:1:1: error: spindle is missing\n"
     "m.toml:9:2: error: unknown key spindel; did you mean spindle?\n"},
    {"12 duplicate key", "min = -110.0", "min = -110.0\nmin = -110.0",
     "m.toml:41:7: error: Error while parsing key-value pair: cannot redefine existing floating-point 'min'\n"},
    {"schema of another version", "schema = 1", "schema = 2", "m.toml:1:10: error: schema = 2 must be 1\n"},
    {"a gear shaper", "\"five_axis\"", "\"gear_shaper\"",
     "m.toml:3:8: error: kind = \"gear_shaper\" is no milling machine; \"five_axis\" is needed here\n"},
    {"pivot length on a table axis", "sign = 1", "sign = 1\npivot_length = 100.0",
     "m.toml:40:16: error: axes.A.pivot_length belongs to head axes; A is in the table\n"},
    {"point with two numbers", "[0.0, 0.0, -285.0]", "[0.0, 0.0]",
     "m.toml:38:9: error: axes.A.point has 2 numbers, must have 3\n"},
    {"point is no list", "[0.0, 0.0, -285.0]", "-285.0",
     "m.toml:38:9: error: axes.A.point must be a list, is a number\n"},
    {"assumed names a key that is not there", "assumed = false", "assumed = [\"axes.Q\"]",
     "m.toml:6:12: error: assumed names \"axes.Q\", which this file does not have\n"},
    {"assumed of a wrong type", "assumed = false", "assumed = 1",
     "m.toml:6:11: error: assumed must be true, false or a list of key names, is a whole number\n"},
    {"unknown TCP mode", "tcp = \"none\"", "tcp = \"both\"",
     "m.toml:5:7: error: tcp = \"both\" is not one of none, angles, vectors\n"},
    {"linear axis in the chain", "[\"C\", \"A\"]", "[\"X\", \"A\"]",
     "m.toml:18:10: error: chain.table lists rotary axes: \"A\", \"B\" or \"C\"\n"
     "m.toml:44:7: error: axes.C is named in neither chain.table nor chain.head\n"},
    {"empty name", "\"example\"", "\"\"", "m.toml:2:8: error: name has 0 characters, allowed are 1 to 120\n"},
    {"line break in the name", "\"example\"", "\"a\\nb\"",
     "m.toml:2:8: error: name contains byte 0x0a; only printable text is allowed\n"},
    {"42 truncated", "max_speed = 12000\n", "max_spe",
     "m.toml:50:8: error: Error while parsing key-value pair: encountered end-of-file\n"},
    {"44 invalid UTF-8", "example", "exam\xffple", "m.toml:2:12: error: Encountered invalid utf-8 sequence\n"},
    {"45 carriage returns only", "schema = 1\n", "schema = 1\r",
     "m.toml:1:12: error: Error while parsing key-value pair: expected '\\n' after '\\r', saw 'n'\n"},
    {"47 nesting", "assumed = false", "assumed = [[[[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]]]]",
     "m.toml:6:27: error: brackets are nested deeper than 16\n"},
    {"head axis without pivot length", "table = [\"C\", \"A\"]\nhead = []", "table = [\"C\"]\nhead = [\"A\"]",
     "m.toml:36:1: error: axes.A.pivot_length is missing\n"
     "m.toml:38:9: error: axes.A.point[2] = -285 must be 0: the height of a head axis is its pivot_length\n"},
    {"spindle is no table", "max_simultaneous_axes = 5\n\n[spindle]\nmax_speed = 24000",
     "max_simultaneous_axes = 5\nspindle = 3", "m.toml:8:11: error: spindle must be a table, is a whole number\n"},
    {"chain of four letters", "[\"C\", \"A\"]", "[\"C\", \"A\", \"B\", \"D\"]",
     "m.toml:18:20: error: axis B is rotary axis number 3, a chain has at most 2\n"
     "m.toml:18:25: error: chain.table lists rotary axes: \"A\", \"B\" or \"C\"\n"},
    {"margin wider than the travel", "[limits]", "[limits]\nlimit_margin_angle = 9.0\nlimit_margin = 200.0",
     "m.toml:14:16: error: limits.limit_margin = 200 exceeds 100 mm\n"},
    {"unknown pole option", "[chain]", "[post]\npole = \"ignore\"\n\n[chain]",
     "m.toml:18:8: error: post.pole = \"ignore\" is not one of error, tilt, hold, through, slow, retract\n"},
    {"too many decimals", "[chain]", "[post]\nlinear_decimals = 12\n\n[chain]",
     "m.toml:18:19: error: post.linear_decimals = 12 is outside 0 to 9\n"},
};

/// Messages with the names of all controls, `list`, where they say {controls}.
inline std::string with_controls(std::string messages, const std::string& list) {
  if (const auto at = messages.find("{controls}"); at != std::string::npos) messages.replace(at, 10, list);
  return messages;
}

/// The same where the control of the machine complains.
inline constexpr BadFile kBadControls[] = {
    {"36 unknown dialect", "\"linuxcnc\"", "\"linuxnc\"",
     "m.toml:4:11: error: dialect = \"linuxnc\" is not one of {controls}\n"},
    {"TCP codes missing", "tcp = \"none\"", "tcp = \"angles\"",
     "m.toml:5:7: error: tcp with dialect \"linuxcnc\" needs post.tcp_on and post.tcp_off: its codes are site data\n"},
    {"cutter locations of joints", "\"linuxcnc\"", "\"apt\"",
     "m.toml:5:7: error: dialect \"apt\" carries tips and tool axes, no joints: tcp = \"vectors\" is supported\n"},
};

}  // namespace toothpath::test
