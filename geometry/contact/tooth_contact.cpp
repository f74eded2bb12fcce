#include "geometry/contact/tooth_contact.h"

#include "geometry/contact/rolling.h"

namespace toothpath::contact {

std::optional<TouchPlace> touch(const ContactMember& member, double phi_2) {
  return TouchSearch<ContactMember>(member, phi_2).best();
}

Result<RollResult> roll(const std::vector<ContactMember>& members, const RollOptions& options) {
  return rolling::rolled(members, options);
}

}  // namespace toothpath::contact
