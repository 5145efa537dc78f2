// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/certificate_figures.hpp"

#include "tests/shared/face_tree.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/shared/test_model.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace tactus::test
{

namespace
{

constexpr double kFlat_quanta = 0.25;

/// Fineness, 4 to 16, of a raster with about `points` points.
std::uint32_t fineness_for(std::size_t faces, std::size_t points)
{
    std::uint32_t fineness = 16;
    while (fineness > 4 && faces * (fineness + 1) * (fineness + 2) / 2 > points)
    {
        --fineness;
    }
    return fineness;
}

/// Greatest distance of the source points nearest to each face; negative without such a point.
std::vector<double> true_errors(const std::vector<Face>& source, const std::vector<Face>& cut,
                                std::size_t points)
{
    const FaceTree tree(cut);
    std::vector<double> errors_m(cut.size(), -1.0);
    visit_raster(source, fineness_for(source.size(), points),
                 [&](const Vec3& point_m)
                 {
                     const FaceTree::Nearest nearest = tree.nearest(point_m);
                     errors_m[nearest.face] = std::max(errors_m[nearest.face], nearest.distance_m);
                 });
    return errors_m;
}

double area_of(const Face& face)
{
    const Vec3 a = to_vec3(face[0]);
    return 0.5 * (to_vec3(face[1]) - a).cross(to_vec3(face[2]) - a).norm();
}

} // namespace

CertificateFigures measure_certificate(const PreparedMesh& prepared,
                                       const Simplification& simplification, std::size_t faces,
                                       std::size_t points)
{
    const CertifiedCut cut = cut_on_the_way(prepared, simplification, faces);
    const std::vector<double> true_m = true_errors(faces_on_grid(prepared), cut.faces, points);
    CertificateFigures figures;
    figures.flat_m = kFlat_quanta * prepared.quantum_m;
    figures.faces = cut.faces.size();
    double area_sum = 0.0;
    for (std::size_t i = 0; i < cut.faces.size(); ++i)
    {
        figures.bound_max_m = std::max(figures.bound_max_m, cut.bounds_m[i]);
        figures.true_max_m = std::max(figures.true_max_m, true_m[i]);
        if (true_m[i] >= 0.0)
        {
            const double area = area_of(cut.faces[i]);
            area_sum += area;
            figures.bound_mean_m += area * cut.bounds_m[i];
            figures.true_mean_m += area * true_m[i];
            figures.face_ratio_mean += area * figures.ratio(cut.bounds_m[i], true_m[i]);
        }
    }
    figures.bound_mean_m /= area_sum;
    figures.true_mean_m /= area_sum;
    figures.face_ratio_mean /= area_sum;
    return figures;
}

} // namespace tactus::test
