// A machine as its file describes it, for people: a table for the screen, a page with a drawing of the chain.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/vec.h"
#include "machines/links.h"
#include "machines/machine.h"
#include "machines/shaper_machine.h"

namespace toothpath::sheet {

/// What a person at the machine sees when this rotary axis gets a positive command: the body that turns (the table, or
/// the head with the tool) and the way it goes, seen along the machine axes of ISO 841.
[[nodiscard]] std::string positive_turn(const machines::KinematicChain& chain, std::size_t rotary);

/// Where a body stands with every joint at its zero: lowest and highest corner of its box, machine coordinates; mm.
struct BodyBox {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
};

/// The link by the name that `of` of a body has: "bed", or the letter of the axis that moves it.
[[nodiscard]] std::string link_name(const machines::Links& links, std::size_t link);

/// Limits, chain, senses, bodies and every assumed value as text; ends with a newline.
/// @param boxes of machine.bodies, in their order; empty: no bodies are listed
[[nodiscard]] std::string machine_text(const machines::Machine& machine, const std::vector<BodyBox>& boxes = {});
[[nodiscard]] std::string machine_text(const machines::ShaperMachine& machine);

/// The chain drawn to scale in an oblique view, all rotary axes at zero: travel of the gauge point, table, rotary axes
/// with the sense in which their bodies turn. A file of its own: white ground, no style sheet.
[[nodiscard]] std::string machine_drawing_svg(const machines::Machine& machine);

/// The same as a page that prints on A4.
[[nodiscard]] std::string machine_page(const machines::Machine& machine, const std::vector<BodyBox>& boxes = {});
[[nodiscard]] std::string machine_page(const machines::ShaperMachine& machine);

}  // namespace toothpath::sheet
