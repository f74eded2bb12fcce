// Tables [[body]] and the key chain.order that are wrong, each with the exact messages that must follow. The good ones
// stand first.
#pragma once

#include <string>

#include "tests/machines/example_files.h"

namespace toothpath::test {

struct Bodies {
  const char* what;
  const char* lines;     ///< behind the example machine, whose last line is 50: the first of them is line 51
  const char* messages;  ///< "" where they are right
};

inline std::string machine_with(const Bodies& bodies) { return std::string(kMachine) + bodies.lines; }
/// The example machine with this `order` in line 20.
inline std::string machine_ordered(const std::string& order) {
  return replaced(kMachine, "head = []", "head = []\norder = " + order);
}

inline constexpr Bodies kBodies[] = {
    {"box, cylinder, cone",
     "[[body]]\nname = \"table\"\nof = \"C\"\nshape = \"cylinder\"\nfrom = [0, 0, -20]\nto = [0, 0, 0]\ndiameter = "
     "400\n"
     "[[body]]\nname = \"cradle\"\nof = \"A\"\nshape = \"box\"\nmin = [-1, -2, -3]\nmax = [1, 2, 3]\ntouches = "
     "[\"table\"]\n"
     "[[body]]\nname = \"nose\"\nof = \"spindle\"\nshape = \"cone\"\nfrom = [0, 0, 0]\nto = [0, 0, 9]\ndiameter = 0\n"
     "diameter_to = 90\n",
     ""},
    {"unknown link", "[[body]]\nname = \"t\"\nof = \"B\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n",
     "m.toml:53:6: error: body[0].of = \"B\" is no link of this machine, which has table, bed, spindle, C, A, X, Y, "
     "Z\n"},
    {"empty box", "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"box\"\nmin = [0, 0, 5]\nmax = [1, 1, 5]\n",
     "m.toml:56:7: error: body[0].max[2] = 5 must exceed body[0].min[2] = 5 by 0.01 mm or more: the box is empty\n"},
    {"no length",
     "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"cylinder\"\nfrom = [0, 0, 5]\nto = [0, 0, 5]\ndiameter = 4\n",
     "m.toml:56:6: error: body[0].to is 0 mm from body[0].from, must be 0.01 mm or more: the body is empty\n"},
    {"no radius",
     "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"cylinder\"\nfrom = [0, 0, 5]\nto = [0, 0, 9]\ndiameter = 0\n",
     "m.toml:57:12: error: body[0].diameter = 0 must be above 0 mm\n"},
    {"a cone without both diameters",
     "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"cone\"\nfrom = [0, 0, 5]\nto = [0, 0, 9]\ndiameter = 0\n"
     "diameter_to = 0.0\n",
     "m.toml:57:12: error: body[0].diameter = 0 mm is below 0.02 mm: the body is empty\n"},
    {"another shape", "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"ball\"\n",
     "m.toml:54:9: error: body[0].shape = \"ball\" is not one of box, cylinder, cone, mesh\n"},
    {"keys of another shape",
     "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\ndiameter = 3\n",
     "m.toml:57:1: error: unknown key body[0].diameter\n"},
    {"missing keys", "[[body]]\nname = \"t\"\nshape = \"mesh\"\n",
     "m.toml:51:1: error: body[0].of is missing\nm.toml:51:1: error: body[0].file is missing\n"},
    {"a name twice, and a name of nothing",
     "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n"
     "[[body]]\nname = \"t\"\nof = \"bed\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\ntouches = [\"table\"]\n",
     "m.toml:58:8: error: body[1].name = \"t\" is the name of another body\n"
     "m.toml:63:11: error: body[1].touches names \"table\", which is no body of this machine\n"},
    {"no list of tables", "[body]\nname = \"t\"\n", "m.toml:51:1: error: body must be a list, is a table\n"},
};

struct Order {
  const char* order;
  const char* messages;
};
inline constexpr Order kOrders[] = {
    {"[\"C\", \"A\", \"bed\", \"X\", \"Y\", \"Z\"]", ""},
    {"[\"C\", \"A\", \"Y\", \"X\", \"bed\", \"Z\"]", ""},
    {"[\"C\", \"A\", \"B\", \"bed\", \"X\", \"Y\", \"Z\"]",
     "m.toml:20:9: error: chain.order names \"B\", which is neither an axis of the chain nor \"bed\"\n"},
    {"[\"C\", \"A\", \"bed\", \"X\", \"Y\"]",
     "m.toml:20:9: error: chain.order must name \"bed\" and every axis once: the rotaries of chain.table first, those "
     "of chain.head last\n"},
    {"[\"A\", \"C\", \"bed\", \"X\", \"Y\", \"Z\"]",
     "m.toml:20:9: error: chain.order must name \"bed\" and every axis once: the rotaries of chain.table first, those "
     "of chain.head last\n"},
    {"[\"C\", \"bed\", \"A\", \"X\", \"Y\", \"Z\"]",
     "m.toml:20:9: error: chain.order must name \"bed\" and every axis once: the rotaries of chain.table first, those "
     "of chain.head last\n"},
};

}  // namespace toothpath::test
