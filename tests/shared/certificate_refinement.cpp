// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/shared/certificate_refinement.hpp"

#include "tests/shared/closest_point.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/shared/test_model.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <stdexcept>

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

ClosedCut::ClosedCut(const DecodedModel& model)
    : model_(model), replay_(model), is_split_(model.header().counts().records)
{
}

std::span<const RecordId> ClosedCut::split_with_closure(RecordId target)
{
    taken_.clear();
    open_.push_back(target);
    while (!open_.empty())
    {
        const RecordId record = open_.back();
        if (const RecordId missing = missing_dependency(record); !missing.is_none())
        {
            open_.push_back(missing);
            continue;
        }
        open_.pop_back();
        if (is_split(record))
        {
            continue;
        }
        if (const auto fault = replay_.split(record))
        {
            throw std::logic_error(*fault);
        }
        is_split_[record.value] = true;
        ++split_count_;
        taken_.push_back(record);
    }
    return taken_;
}

RecordId ClosedCut::missing_dependency(RecordId record) const
{
    const VsplitRecord& fields = model_.record(record);
    for (std::uint32_t i = 0; i < fields.fan_size; ++i)
    {
        const FaceState before = fields.before[i];
        if (!before.is_base() && !is_split(before.record()))
        {
            return before.record();
        }
    }
    return {};
}

/// State of one question: the cut so far, and its faces by their lower bounds.
class CertificateRefinement::Run
{
public:
    Run(const CertificateRefinement& owner, const Vec3& point_m)
        : owner_(owner)
        , model_(owner.model_)
        , point_m_{point_m.x(), point_m.y(), point_m.z()}
        , cut_(model_)
    {
        for (std::uint32_t face = 0; face < model_.header().counts().base_faces; ++face)
        {
            push({face});
        }
    }

    /// Runs until all faces within the radius are exact, or without one until the nearest face is.
    [[nodiscard]] Answer finish(std::optional<double> radius_m)
    {
        Answer answer{std::numeric_limits<double>::infinity(), {}};
        while (!candidates_.empty() && !(candidates_.top().lower_m > radius_m.value_or(kNoLimit)))
        {
            const Candidate top = candidates_.top();
            candidates_.pop();
            if (cut_.replay().state(top.face) != top.state)
            {
                continue; // The face was split since.
            }
            if (model_.error_of(top.face, top.state) != 0)
            {
                split(top, answer);
                continue;
            }
            answer.distance_m = std::min(answer.distance_m, top.lower_m);
            if (!radius_m)
            {
                break;
            }
        }
        return answer;
    }

private:
    static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

    struct Candidate
    {
        double lower_m{0.0};
        FaceId face{};
        FaceState state{};

        /// The lower id comes first among equals.
        [[nodiscard]] bool operator<(const Candidate& other) const
        {
            return lower_m != other.lower_m ? lower_m > other.lower_m : face > other.face;
        }
    };

    void push(FaceId face)
    {
        const FaceState state = cut_.replay().state(face);
        const double bound_m = static_cast<double>(error_in_quanta(model_.error_of(face, state))) *
                               static_cast<double>(model_.header().quantum_m());
        candidates_.push({distance_to(face) - bound_m, face, state});
    }

    [[nodiscard]] double distance_to(FaceId face) const
    {
        std::array<Point<double>, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Vec3f& at_m = model_.position_m(cut_.replay().corners(face)[i]);
            corners[i] = {static_cast<double>(at_m[0]), static_cast<double>(at_m[1]),
                          static_cast<double>(at_m[2])};
        }
        const Point<double> gap =
            difference(point_m_, closest_on_triangle(point_m_, corners[0], corners[1], corners[2]));
        return std::sqrt(dot(gap, gap));
    }

    void split(const Candidate& face, Answer& answer)
    {
        const RecordId next =
            face.state.is_base()
                ? owner_.first_splits_[face.face.value]
                : RecordId{model_.record(face.state.record()).next[face.state.place()]};
        for (const RecordId done : cut_.split_with_closure(next))
        {
            answer.splits.push_back(done);
            const VsplitRecord& record = model_.record(done);
            for (std::uint32_t place = 0; place < record.star_end(); ++place)
            {
                if (!record.star[place].is_none() &&
                    cut_.replay().state(record.star[place]) == FaceState::after(done, place))
                {
                    push(record.star[place]);
                }
            }
        }
    }

    const CertificateRefinement& owner_;
    const DecodedModel& model_;
    Point<double> point_m_;
    ClosedCut cut_;
    std::priority_queue<Candidate> candidates_;
};

CertificateRefinement::CertificateRefinement(const DecodedModel& model)
    : model_(model), first_splits_(model.header().counts().base_faces)
{
    for (std::uint32_t id = 0; id < model.header().counts().records; ++id)
    {
        const VsplitRecord& record = model.record({id});
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            if (record.before[i].is_base())
            {
                first_splits_[record.star[2 + i].value] = {id};
            }
        }
    }
}

CertificateRefinement::Answer CertificateRefinement::find_distance(const Vec3& point_m) const
{
    return Run(*this, point_m).finish(std::nullopt);
}

CertificateRefinement::Answer CertificateRefinement::certify_sphere(const Vec3& center_m,
                                                                    double radius_m) const
{
    return Run(*this, center_m).finish(radius_m);
}

} // namespace tactus::test
