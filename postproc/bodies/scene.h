// The bodies that move in a machine, and which of them may meet.
//
// A gap between two bodies changes by no more than the sum of the ways of the joints between them: of a linear joint
// its way, of a rotary its angle times the reach of one of the two about its axis, whichever is less, in every position
// of the joints between that body and the axis. A body of revolution that turns about its own axis goes nowhere; beside
// it, its reach is the distance of the two axes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "machines/links.h"
#include "postproc/bodies/solid.h"

namespace toothpath::bodies {

enum class Kind : std::uint8_t {
  machine,  ///< of the machine file
  work,     ///< the part, or what holds it: what the tool does there is proven elsewhere
  tool,     ///< a tool in the spindle
};

/// A body and the link that carries it. It stands where it stands with every joint at its zero.
struct Body {
  std::string name;
  std::size_t link = 0;
  Kind kind = Kind::machine;
  Solid solid;
  int tool = 0;                           ///< T of a tool
  std::vector<std::string> touches = {};  ///< names of others that it bears on
};

/// Two bodies that are looked at.
struct Pair {
  std::size_t first = 0, second = 0;  ///< the first is nearer to the work
  /// Of the joints between them, from first.link on: mm of way of the gap for each mm or rad.
  std::vector<double> reach;
};

class Scene {
 public:
  /// The chain must outlive it.
  Scene(const machines::KinematicChain& chain, std::vector<Body> bodies);

  [[nodiscard]] const machines::Links& links() const { return links_; }
  [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }
  /// Pairs whose bodies are carried by different links; but not a tool and the work, nor what bears on one another:
  /// `touches`, or bodies of the machine on neighbouring links that touch with their joint at its zero.
  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  /// Pairs of bodies of the machine that are not looked at for they bear on one another, "table, cradle".
  [[nodiscard]] const std::vector<std::string>& bearing() const { return bearing_; }

  /// Gap of a pair at these joints, up to `within`.
  [[nodiscard]] Gap gap_of(const Pair& pair, const machines::Joints& joints, double within) const;
  /// How deep they are in one another there, with the direction that frees the second, machine coordinates.
  [[nodiscard]] Overlap overlap_of(const Pair& pair, const machines::Joints& joints) const;

 private:
  [[nodiscard]] bool bears(const Body& a, const Body& b) const;
  [[nodiscard]] machines::Place between(const Pair& pair, const std::vector<machines::Place>& places) const;
  [[nodiscard]] double reach(const Body& body, std::size_t joint) const;

  machines::Links links_;
  std::vector<Body> bodies_;
  std::vector<Pair> pairs_;
  std::vector<std::string> bearing_;
};

}  // namespace toothpath::bodies
