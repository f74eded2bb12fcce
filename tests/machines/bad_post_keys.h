// Smoothing and corner keys of [post] that are wrong, each with the exact messages that must follow. The good ones
// stand first.
#pragma once

#include <string>

#include "tests/machines/example_files.h"

namespace toothpath::test {

struct PostKeys {
  const char* what;
  const char* dialect;
  const char* lines;     ///< of [post], the first of them in line 18 of the file
  const char* messages;  ///< "" where the keys are right
};

/// The example machine with this dialect and these lines in [post].
inline std::string machine_with(const PostKeys& keys) {
  const std::string machine = replaced(kMachine, "\"linuxcnc\"", "\"" + std::string(keys.dialect) + "\"");
  return replaced(keys.dialect == std::string("apt") ? replaced(machine, "\"none\"", "\"vectors\"") : machine,
                  "[chain]", "[post]\n" + std::string(keys.lines) + "\n[chain]");
}

inline constexpr PostKeys kPostKeys[] = {
    {"smoothing of a Fanuc", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = "
     "0.01\nsmoothing_axis_tolerance = 0.02\n",
     ""},
    {"smoothing of a Siemens without tool axis", "siemens",
     "smoothing_on = [\"CYCLE832(0.01,_FINISH,1)\"]\nsmoothing_off = [\"CYCLE832()\"]\nsmoothing_tolerance = 0.01\n",
     ""},
    {"smoothing of an M80", "mitsubishi_m80",
     "smoothing_on = [\"G61.4\"]\nsmoothing_off = [\"G64\"]\nsmoothing_tolerance = 1\n", ""},
    {"an offset that programs may overwrite", "linuxcnc", "index_offset = \"G59.3\"\n", ""},
    {"one of a control that turns none", "siemens", "index_offset = \"G505\"\n",
     "m.toml:18:16: error: post.index_offset: dialect \"siemens\" turns no work offset, leave it out\n"},
    {"one that there is not", "linuxcnc", "index_offset = \"G59.4\"\n",
     "m.toml:18:16: error: post.index_offset = \"G59.4\" is none of G54 to G59 and G59.1 to G59.3\n"},
    {"one that is a number", "linuxcnc", "index_offset = 9\n",
     "m.toml:18:16: error: post.index_offset must be a text, is a whole number\n"},
    {"an offset that a control of another kind takes", "fanuc", "transformation_takes_rotary_offset = true\n",
     "m.toml:18:38: error: post.transformation_takes_rotary_offset: dialect \"fanuc\" has no such machine data, leave "
     "it out\n"},
    {"one without the transformation", "siemens", "transformation_takes_rotary_offset = true\n",
     "m.toml:18:38: error: post.transformation_takes_rotary_offset: tcp = \"none\" has no words that it changes, "
     "\"angles\" has; leave it out\n"},
    {"one that is not taken", "siemens", "transformation_takes_rotary_offset = false\n", ""},
    {"one that is a number", "siemens", "transformation_takes_rotary_offset = 1\n",
     "m.toml:18:38: error: post.transformation_takes_rotary_offset must be true or false, is a whole number\n"},
    {"corner tolerance of LinuxCNC", "linuxcnc", "corner_tolerance = 0.1\n", ""},
    {"corner tolerance of a Fanuc", "fanuc", "corner_tolerance = 0.002\n", ""},

    {"coolants of the builder", "fanuc",
     "coolant_mist = [\"M7\", \"M9\"]\ncoolant_through_spindle = [\"M88\", \"M89\"]\n", ""},
    {"coolant is text", "fanuc", "coolant_air = \"M51\"\n",
     "m.toml:18:15: error: post.coolant_air must be a list, is a text\n"},
    {"coolant without its end", "fanuc", "coolant_air = [\"M51\"]\n",
     "m.toml:18:15: error: post.coolant_air has 1 words, must have 2: on and off\n"},
    {"coolant that is always on", "fanuc", "coolant_flood = [\"M8\", \"M8\"]\n",
     "m.toml:18:17: error: post.coolant_flood: M8 cannot mean both on and off\n"},
    {"coolant with a second line", "fanuc", "coolant_flood = [\"M8\\nM3\", \"M9\"]\n",
     "m.toml:18:18: error: post.coolant_flood[0] contains byte 0x0a; only printable ASCII is allowed\n"},
    {"coolant off", "fanuc", "coolant_off = [\"M9\", \"M8\"]\n", "m.toml:18:1: error: unknown key post.coolant_off\n"},

    {"smoothing_on is text", "fanuc",
     "smoothing_on = \"G5.1 Q1\"\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:16: error: post.smoothing_on must be a list, is a text\n"},
    {"smoothing_on holds a number", "fanuc",
     "smoothing_on = [5.1]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:17: error: post.smoothing_on[0] must be a text, is a number\n"},
    {"smoothing_on is empty", "fanuc", "smoothing_on = []\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:16: error: post.smoothing_on is empty, must have at least one block\n"},
    {"smoothing_on has an empty block", "fanuc",
     "smoothing_on = [\"\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:17: error: post.smoothing_on[0] has 0 characters, allowed are 1 to 120\n"},
    {"smoothing_on with a second line", "fanuc",
     "smoothing_on = [\"G5.1 Q1\\nM30\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:17: error: post.smoothing_on[0] contains byte 0x0a; only printable ASCII is allowed\n"},
    {"smoothing_on is no ASCII", "fanuc",
     "smoothing_on = [\"G5.1 Q\u00b9\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:17: error: post.smoothing_on[0] contains byte 0xc2; only printable ASCII is allowed\n"},
    {"smoothing_off is missing", "fanuc", "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:17:1: error: post.smoothing_off is missing\n"},
    {"smoothing_off is true", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = true\nsmoothing_tolerance = 0.01\n",
     "m.toml:19:17: error: post.smoothing_off must be a list, is a boolean\n"},
    {"smoothing_off is empty", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = []\nsmoothing_tolerance = 0.01\n",
     "m.toml:19:17: error: post.smoothing_off is empty, must have at least one block\n"},
    {"smoothing_off alone", "fanuc", "smoothing_off = [\"G5.1 Q0\"]\n",
     "m.toml:18:17: error: post.smoothing_off needs post.smoothing_on\n"},
    {"smoothing_tolerance is missing", "fanuc", "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\n",
     "m.toml:17:1: error: post.smoothing_tolerance is missing\n"},
    {"smoothing_tolerance is text", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = \"0.01\"\n",
     "m.toml:20:23: error: post.smoothing_tolerance must be a number, is a text\n"},
    {"smoothing_tolerance is 0", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 0\n",
     "m.toml:20:23: error: post.smoothing_tolerance = 0 must be above 0 mm\n"},
    {"smoothing_tolerance is negative", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = -0.01\n",
     "m.toml:20:23: error: post.smoothing_tolerance = -0.01 must be above 0 mm\n"},
    {"smoothing_tolerance is infinite", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = inf\n",
     "m.toml:20:23: error: post.smoothing_tolerance = inf must be finite\n"},
    {"smoothing_tolerance is not a number", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = nan\n",
     "m.toml:20:23: error: post.smoothing_tolerance = nan must be finite\n"},
    {"smoothing_tolerance in um", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = 10\n",
     "m.toml:20:23: error: post.smoothing_tolerance = 10 exceeds 1 mm\n"},
    {"smoothing_tolerance alone", "fanuc", "smoothing_tolerance = 0.01\n",
     "m.toml:18:23: error: post.smoothing_tolerance needs post.smoothing_on\n"},
    {"smoothing_axis_tolerance is a list", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = "
     "0.01\nsmoothing_axis_tolerance = [0.02]\n",
     "m.toml:21:28: error: post.smoothing_axis_tolerance must be a number, is a list\n"},
    {"smoothing_axis_tolerance is 0", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = "
     "0.01\nsmoothing_axis_tolerance = 0.0\n",
     "m.toml:21:28: error: post.smoothing_axis_tolerance = 0 must be above 0 deg\n"},
    {"smoothing_axis_tolerance is negative", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = "
     "0.01\nsmoothing_axis_tolerance = -1e-3\n",
     "m.toml:21:28: error: post.smoothing_axis_tolerance = -0.001 must be above 0 deg\n"},
    {"smoothing_axis_tolerance is infinite", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = "
     "0.01\nsmoothing_axis_tolerance = -inf\n",
     "m.toml:21:28: error: post.smoothing_axis_tolerance = -inf must be finite\n"},
    {"smoothing_axis_tolerance is too large", "fanuc",
     "smoothing_on = [\"G5.1 Q1\"]\nsmoothing_off = [\"G5.1 Q0\"]\nsmoothing_tolerance = "
     "0.01\nsmoothing_axis_tolerance = 1.5\n",
     "m.toml:21:28: error: post.smoothing_axis_tolerance = 1.5 exceeds 1 deg\n"},
    {"smoothing_axis_tolerance alone", "linuxcnc", "smoothing_axis_tolerance = 0.02\n",
     "m.toml:18:28: error: post.smoothing_axis_tolerance needs post.smoothing_on\n"},
    {"smoothing under LinuxCNC", "linuxcnc",
     "smoothing_on = [\"G64 P0.01\"]\nsmoothing_off = [\"G61\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:16: error: post.smoothing_on: dialect \"linuxcnc\" has its own words for what may be left of "
     "corners\n"},
    {"smoothing under Heidenhain", "heidenhain",
     "smoothing_on = [\"M120 LA5\"]\nsmoothing_off = [\"M120 LA0\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:16: error: post.smoothing_on: dialect \"heidenhain\" has its own words for what may be left of "
     "corners\n"},
    {"smoothing in cutter location data", "apt",
     "smoothing_on = [\"SPLINE/ON\"]\nsmoothing_off = [\"SPLINE/OFF\"]\nsmoothing_tolerance = 0.01\n",
     "m.toml:18:16: error: post.smoothing_on: dialect \"apt\" has its own words for what may be left of corners\n"},

    {"corner_tolerance is text", "linuxcnc", "corner_tolerance = \"small\"\n",
     "m.toml:18:20: error: post.corner_tolerance must be a number, is a text\n"},
    {"corner_tolerance is 0", "linuxcnc", "corner_tolerance = 0\n",
     "m.toml:18:20: error: post.corner_tolerance = 0 must be above 0 mm\n"},
    {"corner_tolerance is negative", "linuxcnc", "corner_tolerance = -0.0005\n",
     "m.toml:18:20: error: post.corner_tolerance = -0.0005 must be above 0 mm\n"},
    {"corner_tolerance is infinite", "linuxcnc", "corner_tolerance = inf\n",
     "m.toml:18:20: error: post.corner_tolerance = inf must be finite\n"},
    {"corner_tolerance is not a number", "linuxcnc", "corner_tolerance = nan\n",
     "m.toml:18:20: error: post.corner_tolerance = nan must be finite\n"},
    {"corner_tolerance in um", "linuxcnc", "corner_tolerance = 0.5\n",
     "m.toml:18:20: error: post.corner_tolerance = 0.5 exceeds 0.1 mm\n"},
    {"corner_tolerance of a Siemens", "siemens", "corner_tolerance = 0.0005\n",
     "m.toml:18:20: error: post.corner_tolerance belongs to dialect \"linuxcnc\", \"fanuc\", \"mitsubishi_m80\", "
     "\"haas\", this is \"siemens\"\n"},
    {"corner_tolerance in cutter location data", "apt", "corner_tolerance = 0.0005\n",
     "m.toml:18:20: error: post.corner_tolerance belongs to dialect \"linuxcnc\", \"fanuc\", \"mitsubishi_m80\", "
     "\"haas\", this is \"apt\"\n"},
};

}  // namespace toothpath::test
