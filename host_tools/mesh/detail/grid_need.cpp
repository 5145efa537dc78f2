// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/prepare_steps.hpp"
#include "host_tools/mesh/index_lists.hpp"
#include "host_tools/mesh/mesh_places.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tactus::detail
{

namespace
{

constexpr std::size_t kEdgeFacesMax = 4'096;
constexpr std::size_t kPatchesMax = 256;
/// Number of faces for each patch: limits the number of patches of small meshes.
constexpr std::size_t kFacesToPatch = 64;
constexpr std::size_t kPatchFaces = 48;
/// Minimum number of faces of a patch: the normals of fewer are not significant.
constexpr std::size_t kLeastPatchFaces = 8;

constexpr double kStepsInEdge = 16.0;
/// Distance from a multiple of the step, in steps, that counts as one; float's rounding is added.
constexpr double kStepSlack = 1e-5;
constexpr double kFloatSpacing = 0x1p-23;
/// Rounding, in steps, from which multiples of the step are no longer recognized.
constexpr double kCoarsestRounding = 0.25;
/// Shares of the edges and of the patches that may need a finer grid than the chosen one.
constexpr double kShortEdges = 0.01;
constexpr double kFlatterPatches = 0.2;
/// Mean rotation of a face's normal by rounding, in radians: this times the step, over the face's
/// height.
constexpr double kTurnOfStep = 0.5;
constexpr double kSpreadOfTurn = 2.0;
/// Cosine of 30 degrees: normals farther apart belong to a sharp edge.
constexpr double kSmooth = 0.866;
/// Part of the diagonal below which no grid of 24 bits can represent details.
constexpr double kFinest = 0x1p-20;
constexpr std::size_t kMostDigits = 8;
constexpr std::size_t kVerticesRead = 512;

/// Visits at most `most` of the numbers below `count`, spaced by the golden ratio. A fixed step
/// could match the rows of a regular mesh and see only one line of its pattern.
template <typename Visit>
void visit_spread(std::size_t count, std::size_t most, const Visit& visit)
{
    for (std::size_t i = 0; i < std::min(count, most); ++i)
    {
        const std::uint64_t share = i * std::uint64_t{0x9E37'79B9'7F4A'7C15U} >> 32U;
        visit(count <= most ? i : static_cast<std::size_t>(share * count >> 32U));
    }
}

/// True if a value is a multiple of the step, within the rounding of float.
bool is_multiple(double value, double step)
{
    const double steps = value / step;
    const double rounding = kStepSlack + std::abs(steps) * kFloatSpacing;
    return rounding < kCoarsestRounding && std::abs(steps - std::round(steps)) <= rounding;
}

/// Largest power of ten not above a value > 0, by repeated multiplication: the same on every
/// machine.
double decade_of(double value)
{
    double decade = 1.0;
    while (decade * 10.0 <= value)
    {
        decade *= 10.0;
    }
    while (decade > value)
    {
        decade /= 10.0;
    }
    return decade;
}

/// Resolution of the source's coordinates: of float, of a number of decimals, or of a number of
/// digits. 0 if none fits.
double source_step(const TriangleMesh& mesh)
{
    bool are_floats = true;
    std::array<bool, kMostDigits> has_decimals{};
    std::array<bool, kMostDigits> has_digits{};
    has_decimals.fill(true);
    has_digits.fill(true);
    double largest = 0.0;
    const auto read = [&](double x)
    {
        if (x == 0.0)
        {
            return;
        }
        largest = std::max(largest, std::abs(x));
        are_floats = are_floats && static_cast<double>(static_cast<float>(x)) == x;
        double decimal = 1.0;
        double digit = decade_of(std::abs(x));
        for (std::size_t i = 0; i < kMostDigits; ++i)
        {
            has_decimals[i] = has_decimals[i] && is_multiple(x, decimal);
            has_digits[i] = has_digits[i] && is_multiple(x, digit);
            decimal /= 10.0;
            digit /= 10.0;
        }
    };
    visit_spread(mesh.positions.size(), kVerticesRead,
                 [&](std::size_t v) { std::ranges::for_each(mesh.positions[v], read); });
    if (!(largest > 0.0))
    {
        return 0.0;
    }
    double step = are_floats ? largest * 0x1p-23 : 0.0;
    double decimal = 1.0;
    double digit = decade_of(largest);
    for (std::size_t i = 0; i < kMostDigits; ++i)
    {
        step = std::max({step, has_decimals[i] ? decimal : 0.0, has_digits[i] ? digit : 0.0});
        decimal /= 10.0;
        digit /= 10.0;
    }
    return step;
}

/// Quantile of the values, at least one, at a share of 0 to below 1; reorders the values.
double at_share(std::vector<double>& values, double share)
{
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), values.begin() + place, values.end());
    return values[static_cast<std::size_t>(place)];
}

double need_of_edges(const TriangleMesh& mesh, double diagonal)
{
    std::vector<double> lengths;
    const auto measure = [&](std::size_t f)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto& face = mesh.faces[f];
            const double length =
                (place_of(mesh, face[i]) - place_of(mesh, face[(i + 1) % 3])).norm();
            if (length > kFinest * diagonal)
            {
                lengths.push_back(length);
            }
        }
    };
    visit_spread(mesh.faces.size(), kEdgeFacesMax, measure);
    return lengths.empty() ? GridNeed{}.for_edges : at_share(lengths, kShortEdges) / kStepsInEdge;
}

/// Collects the patch of faces around a face and measures the largest step that keeps its relief.
class PatchMeter
{
public:
    explicit PatchMeter(const TriangleMesh& mesh)
        : mesh_(mesh)
        , faces_of_(mesh.positions.size(),
                    [&mesh](const auto& add)
                    {
                        for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
                        {
                            for (const std::uint32_t vertex : mesh.faces[f])
                            {
                                add(vertex, f);
                            }
                        }
                    })
        , patch_of_(mesh.faces.size(), 0)
    {
    }

    /// Largest step for the patch around a face; infinite if the patch is too small.
    double need(std::uint32_t seed)
    {
        gather(seed);
        Vec3 sum = Vec3::Zero();
        double double_area = 0.0;
        double longest_sides = 0.0;
        for (const std::uint32_t face : patch_)
        {
            const Vec3 normal = normal_of(face);
            sum += normal;
            double_area += normal.norm();
            longest_sides += longest_side(face);
        }
        if (patch_.size() < kLeastPatchFaces || !(double_area > 0.0))
        {
            return GridNeed{}.for_relief;
        }
        const double mean = std::min(1.0, sum.norm() / double_area);
        const double spread = std::sqrt(2.0 * (1.0 - mean));
        const double height = double_area / longest_sides;
        return spread * height / (kSpreadOfTurn * kTurnOfStep);
    }

private:
    /// Normal of a face; its length is twice the area.
    [[nodiscard]] Vec3 normal_of(std::uint32_t face) const
    {
        const auto& [a, b, c] = mesh_.faces[face];
        const Vec3 origin = place_of(mesh_, a);
        return (place_of(mesh_, b) - origin).cross(place_of(mesh_, c) - origin);
    }

    [[nodiscard]] double longest_side(std::uint32_t face) const
    {
        const auto& [a, b, c] = mesh_.faces[face];
        return std::sqrt(std::max({(place_of(mesh_, a) - place_of(mesh_, b)).squaredNorm(),
                                   (place_of(mesh_, b) - place_of(mesh_, c)).squaredNorm(),
                                   (place_of(mesh_, c) - place_of(mesh_, a)).squaredNorm()}));
    }

    /// Collects a patch, breadth first over common vertices.
    void gather(std::uint32_t seed)
    {
        ++patches_;
        patch_.assign(1, seed);
        patch_of_[seed] = patches_;
        const Vec3 upright = normal_of(seed).normalized();
        for (std::size_t at = 0; at < patch_.size(); ++at)
        {
            for (const std::uint32_t vertex : mesh_.faces[patch_[at]])
            {
                for (const std::uint32_t next : faces_of_.of(vertex))
                {
                    if (patch_.size() == kPatchFaces)
                    {
                        return;
                    }
                    if (patch_of_[next] == patches_)
                    {
                        continue;
                    }
                    patch_of_[next] = patches_;
                    const Vec3 normal = normal_of(next);
                    if (normal.dot(upright) >= kSmooth * normal.norm())
                    {
                        patch_.push_back(next);
                    }
                }
            }
        }
    }

    const TriangleMesh& mesh_;
    IndexLists faces_of_;                 ///< Faces by vertex.
    std::vector<std::uint32_t> patch_of_; ///< Last patch that reached each face.
    std::uint32_t patches_{0};
    std::vector<std::uint32_t> patch_;
};

double need_of_relief(const TriangleMesh& mesh, double diagonal)
{
    const std::size_t count = std::min(kPatchesMax, mesh.faces.size() / kFacesToPatch);
    if (count == 0)
    {
        return GridNeed{}.for_relief;
    }
    // The source's own rounding of a flat place does not count as relief.
    const double flat = std::max(kFinest / 4.0 * diagonal, 2.0 * source_step(mesh));
    PatchMeter meter(mesh);
    std::vector<double> needs;
    visit_spread(mesh.faces.size(), count,
                 [&](std::size_t face)
                 {
                     const double need = meter.need(static_cast<std::uint32_t>(face));
                     needs.push_back(need < flat ? GridNeed{}.for_relief : need);
                 });
    return at_share(needs, kFlatterPatches);
}

} // namespace

GridNeed measure_grid_need(const TriangleMesh& mesh)
{
    const double diagonal = box_of(mesh).diagonal().stableNorm();
    return {need_of_edges(mesh, diagonal), need_of_relief(mesh, diagonal)};
}

} // namespace tactus::detail
