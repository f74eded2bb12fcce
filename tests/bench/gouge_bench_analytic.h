// The analytic engine of a face gear against CGAL on a mesh of the same ring: random poses in contact with flanks and
// fillets.
#pragma once

namespace toothpath::bench {

/// Prints its rows: the ball, and the whole assembly at the analytic engine's own resolution.
void analytic_rows();

}  // namespace toothpath::bench
