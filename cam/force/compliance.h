// A mill as a cantilever: its profile, clamped where the holder begins, bent by a force across its axis.
//
// T frame: heights above the tip, mm; forces N. The holder and all above it are rigid; so are spindle and part.
#pragma once

#include "cam/tool/profile.h"
#include "geometry/base/result.h"

namespace toothpath::force {

/// What a mill is made of, and how much of it bears. Defaults: cemented carbide.
struct Elasticity {
  double youngs_modulus_N_mm2 = 600e3;
  double poisson = 0.22;
  double flute_share = 0.8;  ///< diameter that bears in the flutes, of the envelope; 1 in the shank
};

/// Deflection a newton, mm/N.
struct Compliance {
  double bending = 0, shear = 0;
  [[nodiscard]] double total() const { return bending + shear; }
};

/// Deflection at one height of the tool by a force of 1 N across the axis at another one; the two may be exchanged.
///
///     bending = int (h - a)(h - b) / (E I) dh,  shear = int dh / (k G A)      from max(a, b) to the holder,
///     I = pi d^4/64, A = pi d^2/4, G = E/(2 (1 + nu)), k = 6 (1 + nu)/(7 + 6 nu)
///
/// @param load_mm  a, where the force acts;  @param at_mm  b, where the deflection is asked; both above the tip and
///                 below the holder
/// Every piece of the meridian by Gauss's rule of order 20, halved until two levels agree to 1e-10 of it: error below
/// 1e-9 of the result. Source: Euler and Timoshenko beams; k of a full circle: Cowper 1966.
/// Refused: a height outside of that range; a profile without a radius between it and the holder.
[[nodiscard]] Result<Compliance> compliance(const tool::Profile& mill, double load_mm, double at_mm,
                                            const Elasticity& of = {});

/// Where the holder begins, above the tip; the end of the shank where there is none.
[[nodiscard]] double clamped_at(const tool::Profile& mill);

}  // namespace toothpath::force
