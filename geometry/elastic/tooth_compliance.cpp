#include "geometry/elastic/tooth_compliance.h"

#include "geometry/elastic/factored_row.h"

namespace toothpath::elastic {
namespace {

FaceNodes nodes_of(const Sector& s, const StationFace& f) {
  FaceNodes x;
  for (int n = 0; n < kFaceNodes; ++n)
    x.col(n) = s.nodes[static_cast<std::size_t>(f.nodes[static_cast<std::size_t>(n)])];
  return x;
}

/// Every place of integration of the loaded flank, with its weight.
template <typename F>
void over_flank(const Sector& s, F&& at) {
  const GaussRule& rule = gauss_rule(4);
  for (const auto& face : s.faces)
    for (int i = 0; i < rule.n; ++i)
      for (int j = 0; j < rule.n; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        at(face, face_place(nodes_of(s, face), rule.x[a], rule.x[b]), rule.weight[a], rule.weight[b]);
      }
}

}  // namespace

std::vector<double> hat_areas(const Sector& s) {
  std::vector<double> areas(s.stations.size(), 0.0);
  over_flank(s, [&](const auto& face, const FacePlace& place, double w_a, double w_b) {
    const double area = place.area.norm() * w_a * w_b;
    for (std::size_t c = 0; c < 4; ++c) areas[static_cast<std::size_t>(face.stations[c])] += place.hat[c] * area;
  });
  return areas;
}

Eigen::MatrixXd hat_loads(const Sector& s) {
  const std::vector<double> areas = hat_areas(s);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * s.nodes.size()),
                                                static_cast<Eigen::Index>(s.stations.size()));
  over_flank(s, [&](const auto& face, const FacePlace& place, double w_a, double w_b) {
    const Vec3 force = -place.area * (w_a * w_b);
    for (std::size_t c = 0; c < 4; ++c) {
      const int station = face.stations[c];
      for (int n = 0; n < kFaceNodes; ++n)
        loads.block<3, 1>(3 * face.nodes[static_cast<std::size_t>(n)], station) +=
            force * (place.shape(n) * place.hat[c] / areas[static_cast<std::size_t>(station)]);
    }
  });
  return loads;
}

Result<ToothCompliance> tooth_compliance(const Sector& s, double nu, int teeth) {
  const auto row = FactoredRow::make(s, nu, teeth);
  if (!row) return row.error();
  const auto stations = static_cast<Eigen::Index>(s.stations.size());
  Eigen::MatrixXd at_stations = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * s.nodes.size()), stations);
  for (Eigen::Index k = 0; k < stations; ++k) {
    const auto n = static_cast<std::size_t>(k);
    at_stations.block<3, 1>(3 * s.stations[n], k) = -s.normals[n];
  }
  const FactoredRow::Forward load = row->forward(hat_loads(s)), read = row->forward(at_stations);
  const Eigen::MatrixXd motions = row->motions(load.cuts);

  ToothCompliance out;
  out.reach = row->reach();
  for (int o = -out.reach; o <= out.reach; ++o) {
    Eigen::MatrixXd C = read.cuts.transpose() * row->cuts_of(motions, o);
    if (o == 0) C += read.inside.transpose() * load.inside;
    out.at_offset.push_back(std::move(C));
  }
  const Eigen::MatrixXd& own = out.at_offset[static_cast<std::size_t>(out.reach)];
  out.reciprocity = (own - own.transpose()).cwiseAbs().maxCoeff() / own.cwiseAbs().maxCoeff();
  return out;
}

Result<ToothFields> tooth_fields(const Sector& s, double nu, int teeth) {
  const auto row = FactoredRow::make(s, nu, teeth);
  if (!row) return row.error();
  const FactoredRow::Forward load = row->forward(hat_loads(s));
  const Eigen::MatrixXd motions = row->motions(load.cuts);
  ToothFields out;
  out.reach = row->reach();
  for (int o = -out.reach; o <= out.reach; ++o)
    out.at_offset.push_back(row->nodes_of(row->cuts_of(motions, o), o == 0 ? &load.inside : nullptr));
  return out;
}

}  // namespace toothpath::elastic
