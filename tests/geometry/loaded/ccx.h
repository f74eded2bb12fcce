// CalculiX run on a deck, and what it prints.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::test {

inline bool ccx_is_there() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What CalculiX writes: printed numbers, and fields at nodes.
struct CcxResults {
  std::string dat, frd;
};

/// Runs a deck in a directory of its own.
inline CcxResults run_deck(const std::string& deck, const std::string& name) {
  const auto dir = std::filesystem::temp_directory_path() / ("toothpath_ccx_" + name + std::to_string(::getpid()));
  std::filesystem::create_directories(dir);
  std::ofstream(dir / "deck.inp") << deck;
  const std::string command = "cd '" + dir.string() + "' && OMP_NUM_THREADS=1 ccx -i deck > ccx.log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "see " << dir;
  CcxResults out{text_of(dir / "deck.dat"), text_of(dir / "deck.frd")};
  std::filesystem::remove_all(dir);
  return out;
}

/// The numbers of the .dat file that stand a node and three values a line.
inline std::vector<std::pair<int, Vec3>> vectors_at_nodes(const std::string& dat) {
  std::istringstream in(dat);
  std::vector<std::pair<int, Vec3>> out;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    int node = 0;
    Vec3 v;
    if (words >> node >> v.x() >> v.y() >> v.z() && (words >> std::ws).eof()) out.emplace_back(node, v);
  }
  return out;
}

/// Of reactions about an axis: the nodes stand in the deck.
inline double moment_of(const std::string& deck, const std::vector<std::pair<int, Vec3>>& reactions, const Vec3& origin,
                        const Vec3& axis) {
  std::istringstream in(deck);
  std::string line;
  std::vector<Vec3> nodes;
  while (std::getline(in, line) && line.find("*ELEMENT") == std::string::npos) {
    int id = 0;
    Vec3 p;
    if (std::sscanf(line.c_str(), "%d, %lf, %lf, %lf", &id, &p.x(), &p.y(), &p.z()) == 4) nodes.push_back(p);
  }
  double moment = 0;
  for (const auto& [node, f] : reactions)
    moment += (nodes.at(static_cast<std::size_t>(node - 1)) - origin).cross(f).dot(axis);
  return moment;
}

}  // namespace toothpath::test
