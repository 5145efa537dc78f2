// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I11: influence boxes miss no chunk that a sphere needs.

#include "host_tools/encode/influence.hpp"
#include "host_tools/encode/replay.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace tactus
{
namespace
{

/// Face that one record splits: its corners before the split, and its bound.
struct SplitFace
{
    Triangle corners;
    double error_m;
};

std::vector<std::vector<SplitFace>> find_split_faces(const DecodedModel& model)
{
    std::vector<std::vector<SplitFace>> all(model.header().counts().records);
    Replay replay(model);
    for (const RecordId id : in_dependency_order(model))
    {
        const VsplitRecord& record = model.record(id);
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const FaceId face = record.star[2 + i];
            SplitFace split{
                {},
                static_cast<double>(error_in_quanta(model.error_of(face, record.before[i]))) *
                    static_cast<double>(model.header().quantum_m())};
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                split.corners[corner] = to_vec3(model.position_m(replay.corners(face)[corner]));
            }
            all[id.value].push_back(split);
        }
        EXPECT_FALSE(replay.split(id));
    }
    return all;
}

/// Records that a sphere needs: those that split a face state in its reach, and all dependencies.
/// More than any single cut can request.
std::set<std::uint32_t> find_needed(const DecodedModel& model,
                                    const std::vector<std::vector<SplitFace>>& split_faces,
                                    const Vec3& centre_m, double radius_m)
{
    std::set<std::uint32_t> needed;
    std::vector<std::uint32_t> stack;
    for (std::uint32_t id = 0; id < split_faces.size(); ++id)
    {
        for (const SplitFace& face : split_faces[id])
        {
            if (test::DistanceOracle::distance(centre_m, face.corners) <=
                static_cast<long double>(face.error_m) + static_cast<long double>(radius_m))
            {
                stack.push_back(id);
            }
        }
    }
    while (!stack.empty())
    {
        const std::uint32_t id = stack.back();
        stack.pop_back();
        if (!needed.insert(id).second)
        {
            continue;
        }
        const VsplitRecord& record = model.record({id});
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            if (!record.before[i].is_base())
            {
                stack.push_back(record.before[i].record().value);
            }
        }
    }
    return needed;
}

/// Every chunk's box in metres, as read from the index.
std::vector<Eigen::AlignedBox3d> read_chunk_boxes(const ModelStore& store)
{
    std::vector<Eigen::AlignedBox3d> boxes;
    const ModelHeader& header = store.header();
    const double quantum_m = static_cast<double>(header.quantum_m());
    std::vector<std::byte> coded;
    std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    for (std::uint32_t page = 0; page < header.counts().index_pages(); ++page)
    {
        IndexPage index;
        EXPECT_TRUE(store.read({ContentKind::index_page, page}, coded));
        EXPECT_TRUE(parse_index_page(coded, header.counts(), {page}, index, entries));
        const QuantumBox outer = header.index_entry({page}).box;
        for (std::uint32_t i = 0; i < index.chunks; ++i)
        {
            Eigen::AlignedBox3d& box = boxes.emplace_back();
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double step = index_step(outer.low[axis], outer.high[axis]);
                const auto at = static_cast<Eigen::Index>(axis);
                box.min()[at] = (outer.low[axis] + index.low[axis][i] * step) * quantum_m;
                box.max()[at] = (outer.low[axis] + index.high[axis][i] * step) * quantum_m;
            }
        }
    }
    return boxes;
}

TEST(Influence, boxes_miss_no_chunk_that_a_sphere_needs)
{
    constexpr unsigned kSeed = 20'260'101;
    for (const auto& model : sample_models())
    {
        const auto split_faces = find_split_faces(*model->decoded);
        const auto boxes = read_chunk_boxes(*model->store);
        const double diagonal_m = model->store->header().diagonal_m();
        std::mt19937 random(kSeed);
        std::uniform_int_distribution<std::uint32_t> any_vertex(
            0, model->store->header().counts().vertices() - 1);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        std::size_t needed_chunks = 0;
        std::size_t spared_chunks = 0;
        for (int sphere = 0; sphere < 60; ++sphere)
        {
            const double radius_m =
                diagonal_m * (sphere % 3 == 0 ? 0.001 : 0.03) * (1 + unit(random));
            const Vec3 offset{unit(random), unit(random), unit(random)};
            const Vec3 centre_m =
                to_vec3(model->decoded->position_m({any_vertex(random)})) + offset * radius_m;
            std::set<std::uint32_t> chunks;
            for (const std::uint32_t record :
                 find_needed(*model->decoded, split_faces, centre_m, radius_m))
            {
                chunks.insert(chunk_of({record}).value);
            }
            needed_chunks += chunks.size();
            for (std::uint32_t chunk = 0; chunk < boxes.size(); ++chunk)
            {
                const bool meets = boxes[chunk].exteriorDistance(centre_m) <= radius_m;
                EXPECT_TRUE(meets || chunks.count(chunk) == 0)
                    << model->name << ", sphere " << sphere << " of seed " << kSeed << ", chunk "
                    << chunk;
                spared_chunks += meets ? 0 : 1;
            }
        }
        EXPECT_GT(needed_chunks, 0U) << model->name;
        // Boxes that contain everything would miss nothing either.
        if (boxes.size() > 16)
        {
            EXPECT_GT(spared_chunks, 0U) << model->name;
        }
    }
}

TEST(Influence, a_box_holds_the_inflated_fans_of_its_records)
{
    for (const auto& model : sample_models())
    {
        const auto split_faces = find_split_faces(*model->decoded);
        const auto boxes = read_chunk_boxes(*model->store);
        for (std::uint32_t id = 0; id < split_faces.size(); ++id)
        {
            const Eigen::AlignedBox3d& box = boxes[chunk_of({id}).value];
            for (const SplitFace& face : split_faces[id])
            {
                for (const Vec3& corner : face.corners)
                {
                    const Vec3 margin = Vec3::Constant(face.error_m);
                    EXPECT_TRUE(box.contains((corner - margin).eval()) &&
                                box.contains((corner + margin).eval()))
                        << model->name << ", record " << id;
                }
            }
        }
    }
}

TEST(Influence, reach_holds_star_and_fan_with_their_bounds)
{
    for (const auto& model : sample_models())
    {
        const DecodedModel& decoded = *model->decoded;
        const double quantum_m = static_cast<double>(decoded.header().quantum_m());
        const auto split_faces = find_split_faces(decoded);
        for (std::uint32_t id = 0; id < split_faces.size(); ++id)
        {
            const VsplitRecord& record = decoded.record({id});
            const double reach_m = static_cast<double>(error_in_quanta(record.reach)) * quantum_m;
            double farthest_m = 0.0;
            for (const SplitFace& face : split_faces[id])
            {
                for (const Vec3& corner : face.corners)
                {
                    farthest_m = std::max(farthest_m, (corner - to_vec3(record.position_m)).norm() +
                                                          face.error_m);
                }
            }
            EXPECT_GE(reach_m, farthest_m) << model->name << ", record " << id;
        }
    }
}

TEST(Influence, relative_boxes_are_rounded_outward_and_stay_in_16_bits)
{
    const QuantumBox page{{-70'000, 0, 5}, {1'000'000, 65'535, 5}};
    for (const QuantumBox& box : {page, QuantumBox{{-69'999, 1, 5}, {-69'998, 2, 5}},
                                  QuantumBox{{999'999, 65'535, 5}, {1'000'000, 65'535, 5}}})
    {
        const InfluenceBox sut = relative_to(page, box);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::int64_t step = index_step(page.low[axis], page.high[axis]);
            EXPECT_LE(page.low[axis] + sut.low[axis] * step, box.low[axis]);
            EXPECT_GE(page.low[axis] + sut.high[axis] * step, box.high[axis]);
            EXPECT_LT(box.low[axis] - (page.low[axis] + sut.low[axis] * step), step);
            EXPECT_LT(page.low[axis] + sut.high[axis] * step - box.high[axis], step);
        }
    }
}

} // namespace
} // namespace tactus
