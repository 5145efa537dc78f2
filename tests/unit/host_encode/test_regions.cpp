// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I11: with exactly the chunks that the two-level index names for a zone, the controller's linker
/// and forest restore every source face that the zone touches.

#include "host_tools/encode/replay.hpp"
#include "platform/machine/pool_memory.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/influence_index.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"
#include "tests/unit/rt_core/support.hpp"
#include "transport/store/model_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace tactus::test
{
namespace
{

/// Model with base mesh and selected chunks only, loaded directly.
struct FedModel
{
    /// Parses and links the chunks. The store must outlive it.
    FedModel(const ModelStore& store, std::span<const ChunkId> chunks);

    /// Splits every linked record.
    void split_linked();

    /// True if the face is active in this state and no record splits it further.
    [[nodiscard]] bool is_exact(FaceId face, FaceState state) const;

private:
    void make_model(std::uint32_t chunks);
    void feed(ChunkId chunk, std::uint32_t slot);

    const ModelStore& store_;
    std::optional<PoolMemory> memory_;
    std::optional<Arena> arena_;
    std::optional<ModelPools> pools_;
    std::optional<Model> model_;
    std::vector<ChunkId> chunks_;
};

std::vector<std::byte> read_piece(const ModelStore& store, ContentKey key)
{
    std::vector<std::byte> coded;
    if (const auto done = store.read(key, coded); !done)
    {
        throw std::runtime_error(done.error().text);
    }
    return coded;
}

FedModel::FedModel(const ModelStore& store, std::span<const ChunkId> chunks)
    : store_(store), chunks_(chunks.begin(), chunks.end())
{
    make_model(static_cast<std::uint32_t>(chunks.size()));
    for (std::uint32_t slot = 0; slot < chunks.size(); ++slot)
    {
        feed(chunks[slot], slot);
    }
    Linker::Update update;
    while (model_->linker.try_take_update(update))
    {
        model_->pages.update_linked(update.chunk, update.slot, update.linked);
    }
}

void FedModel::make_model(std::uint32_t chunks)
{
    const ModelHeader& header = store_.header();
    ModelCapacities capacities;
    capacities.pages = std::max(chunks, 1U);
    capacities.index_pages = 1;
    capacities.faces = header.counts().base_faces + 2 * kRecordsPerChunk * chunks;
    capacities.blocks = capacities.faces / 2 + 2 * AbTree::kReserve;
    capacities.nodes = capacities.blocks;
    Arena scratch = Arena::measuring();
    const RefineScratch beside(scratch, 0);
    memory_.emplace(scratch.used() + required_bytes({&header, 1}, {&capacities, 1}));
    arena_.emplace(memory_->span());
    pools_.emplace(*arena_, capacities, 1);
    const PageSlots slots = pools_->slots.of_model(*arena_, header.counts());
    if (!parse_base_mesh(read_piece(store_, {ContentKind::base, 0}), header, slots.base))
    {
        throw std::runtime_error("the base mesh can't be parsed");
    }
    model_.emplace(*arena_, *pools_, ModelId{0}, header, slots, capacities, best_kernels());
}

void FedModel::feed(ChunkId chunk, std::uint32_t slot)
{
    if (!parse_chunk(read_piece(store_, {ContentKind::chunk, chunk.value}), store_.header(), chunk,
                     model_->slots.pages[slot]))
    {
        throw std::runtime_error("a chunk can't be parsed");
    }
    model_->linker.link_page(chunk, slot);
    model_->pages.adopt(chunk, slot, ChunkCache::kFirstFrame, model_->linker.tell_linked(slot));
}

void FedModel::split_linked()
{
    std::vector<std::pair<std::uint32_t, RecordId>> by_depth;
    for (const ChunkId chunk : chunks_)
    {
        for (std::uint32_t place = 0; place < kRecordsPerChunk; ++place)
        {
            const RecordId id{(chunk.value << kRecordsPerChunkLog2) + place};
            if (const VsplitRecord* record = model_->pages.find_linked(id))
            {
                by_depth.emplace_back(record->depth, id);
            }
        }
    }
    std::sort(by_depth.begin(), by_depth.end());
    for (const auto& [depth, id] : by_depth)
    {
        if (model_->forest.split(id) != VertexForest::SplitOutcome::done)
        {
            throw std::runtime_error("a linked record can't be split");
        }
    }
}

bool FedModel::is_exact(FaceId face, FaceState state) const
{
    const PrimId prim = model_->forest.find(face);
    return prim.value != IdTable::kAbsent && model_->forest.face(prim).state == state &&
           model_->forest.next_of(prim) == kNextExact && model_->forest.error_of(prim) == 0;
}

constexpr int kZones = 40;

/// Face after full refinement.
struct SourceFace
{
    FaceId id;
    FaceState state;
    Face corners_m;
};

std::vector<SourceFace> source_faces(const DecodedModel& model)
{
    Replay replay(model);
    for (const RecordId id : in_dependency_order(model))
    {
        if (const auto fault = replay.split(id))
        {
            throw std::runtime_error(*fault);
        }
    }
    std::vector<SourceFace> faces;
    for (std::uint32_t i = 0; i < model.header().counts().face_ids(); ++i)
    {
        if (replay.is_active({i}))
        {
            SourceFace& face = faces.emplace_back(SourceFace{{i}, replay.state({i}), {}});
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                face.corners_m[corner] = model.position_m(replay.corners({i})[corner]);
            }
        }
    }
    return faces;
}

/// Part of a polygon on the side of an axis-aligned plane with sign x coordinate <= sign x limit.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, Eigen::Index axis, double limit,
                          double sign)
{
    std::vector<Vec3> left;
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
        const Vec3& a = polygon[i];
        const Vec3& b = polygon[(i + 1) % polygon.size()];
        const double beyond_a = sign * (a[axis] - limit);
        const double beyond_b = sign * (b[axis] - limit);
        if (beyond_a <= 0.0)
        {
            left.push_back(a);
        }
        if (beyond_a * beyond_b < 0.0)
        {
            left.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
        }
    }
    return left;
}

/// Separate decision: brute force in extended precision, or clipping.
bool is_touched(const Zone& zone, const Face& face)
{
    if (const auto* sphere = std::get_if<SphereZone>(&zone))
    {
        return brute_distance(sphere->center_m, face) <= static_cast<long double>(sphere->radius_m);
    }
    const auto& box = std::get<BoxZone>(zone);
    std::vector<Vec3> polygon{to_vec3(face[0]), to_vec3(face[1]), to_vec3(face[2])};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        polygon = clipped(polygon, axis, box.high_m[axis], 1.0);
        polygon = clipped(polygon, axis, box.low_m[axis], -1.0);
    }
    return !polygon.empty();
}

/// Corner of the source, midpoint of an edge, corner of the model's box or of one of the header's
/// regions, or a place beside a corner of the source.
Vec3 random_center(const ModelHeader& header, const std::vector<SourceFace>& faces, Random& random)
{
    const Face& face = faces[random.below(static_cast<std::uint32_t>(faces.size()))].corners_m;
    const double quantum_m = static_cast<double>(header.quantum_m());
    Vec3 place;
    switch (random.below(5))
    {
    case 0:
        return to_vec3(face[0]);
    case 1:
        return 0.5 * (to_vec3(face[0]) + to_vec3(face[1]));
    case 2:
        for (Eigen::Index axis = 0; axis < 3; ++axis)
        {
            const auto at = static_cast<std::size_t>(axis);
            place[axis] = random.one_in(2) ? 0.0 : header.fields().extent_quanta[at] * quantum_m;
        }
        return place;
    case 3:
        place = to_vec3(face[0]) / (header.fields().region_cell_quanta * quantum_m);
        return place.array().round().matrix() * (header.fields().region_cell_quanta * quantum_m);
    default:
        return to_vec3(face[0]) + random.in_cube(0.05 * header.diagonal_m());
    }
}

/// Zone from less than a face to the whole model; a box may be a slab, a rod or a point.
Zone random_zone(const ModelHeader& header, const std::vector<SourceFace>& faces, Random& random)
{
    const Vec3 center_m = random_center(header, faces, random);
    const auto any_size = [&]
    { return header.diagonal_m() * std::pow(10.0, random.between(-4, 0)); };
    if (random.one_in(2))
    {
        return SphereZone{center_m, any_size()};
    }
    const Vec3 half_m{random.one_in(8) ? 0.0 : any_size(), any_size(), any_size()};
    return BoxZone{center_m - half_m, center_m + half_m};
}

std::string name_of(const Zone& zone)
{
    std::ostringstream text;
    if (const auto* sphere = std::get_if<SphereZone>(&zone))
    {
        text << "sphere at " << sphere->center_m.transpose() << ", radius " << sphere->radius_m;
    }
    else
    {
        const auto& box = std::get<BoxZone>(zone);
        text << "box from " << box.low_m.transpose() << " to " << box.high_m.transpose();
    }
    return text.str();
}

/// Model with its index and the faces that it must restore.
struct Subject
{
    explicit Subject(std::unique_ptr<EncodedModel> encoded)
        : model(std::move(encoded)), index(*model->store), faces(source_faces(*model->decoded))
    {
    }

    [[nodiscard]] std::vector<SourceFace> touched_by(const Zone& zone) const
    {
        std::vector<SourceFace> touched;
        std::copy_if(faces.begin(), faces.end(), std::back_inserter(touched),
                     [&](const SourceFace& face) { return is_touched(zone, face.corners_m); });
        return touched;
    }

    /// Number of wanted faces missing after all linked records of these chunks are split.
    [[nodiscard]] std::size_t missing(const std::vector<SourceFace>& wanted,
                                      std::span<const ChunkId> chunks) const
    {
        FedModel fed(*model->store, chunks);
        fed.split_linked();
        return static_cast<std::size_t>(std::count_if(
            wanted.begin(), wanted.end(),
            [&](const SourceFace& face) { return !fed.is_exact(face.id, face.state); }));
    }

    std::unique_ptr<EncodedModel> model;
    InfluenceIndex index;
    std::vector<SourceFace> faces;
};

struct Regions : testing::TestWithParam<SampleMesh>
{
    void SetUp() override
    {
        auto model = GetParam().encode();
        if (model == nullptr)
        {
            GTEST_SKIP() << "TACTUS_MESHES is not set";
        }
        subject_.emplace(std::move(model));
    }

    [[nodiscard]] const ModelHeader& header() const { return subject_->model->store->header(); }

    std::optional<Subject> subject_;
    Random random_{77};
};

TEST_P(Regions, come_back_whole_from_the_chunks_that_the_index_names_and_no_other)
{
    std::size_t touched_sum = 0;
    std::size_t spared_sum = 0;
    for (int i = 0; i < kZones; ++i)
    {
        const Zone zone = random_zone(header(), subject_->faces, random_);
        const std::vector<SourceFace> touched = subject_->touched_by(zone);
        const std::vector<ChunkId> chunks = subject_->index.named_by(zone).chunks;
        EXPECT_EQ(subject_->missing(touched, chunks), 0U)
            << "of " << touched.size() << ", zone " << i << ": " << name_of(zone);
        touched_sum += touched.size();
        spared_sum += header().counts().chunks() - chunks.size();
    }
    EXPECT_GT(touched_sum, 0U);
    EXPECT_GT(spared_sum, 0U); // An index that names everything would miss nothing either.
}

TEST_P(Regions, lack_a_face_when_the_chunk_that_brings_it_is_left_out)
{
    std::size_t tried = 0;
    for (int i = 0; i < kZones; ++i)
    {
        const Zone zone = random_zone(header(), subject_->faces, random_);
        const std::vector<SourceFace> touched = subject_->touched_by(zone);
        const auto split_face =
            std::find_if(touched.begin(), touched.end(),
                         [](const SourceFace& face) { return !face.state.is_base(); });
        if (split_face == touched.end())
        {
            continue;
        }
        std::vector<ChunkId> chunks = subject_->index.named_by(zone).chunks;
        ASSERT_EQ(std::erase(chunks, chunk_of(split_face->state.record())), 1U) << name_of(zone);
        EXPECT_GT(subject_->missing(touched, chunks), 0U) << name_of(zone);
        ++tried;
    }
    EXPECT_GT(tried, 0U);
}

TEST_P(Regions, are_asked_for_by_the_controller_as_the_index_names_them)
{
    TestModel model;
    model.name = "model";
    model.path = subject_->model->path;
    model.diagonal_m = header().diagonal_m();
    for (int i = 0; i < 5; ++i)
    {
        FrameRig rig(model, with_room_for_all());
        const SphereZone sphere{random_center(header(), subject_->faces, random_),
                                header().diagonal_m() * std::pow(10.0, random_.between(-3, -0.5))};
        load_region(rig, {ModelId{0}, sphere.center_m, sphere.radius_m, 0});
        std::set<ChunkId> here;
        for (std::uint32_t chunk = 0; chunk < header().counts().chunks(); ++chunk)
        {
            if (rig.model().pages.find({chunk}) != IdTable::kAbsent)
            {
                here.insert({chunk});
            }
        }
        const auto named = subject_->index.named_by(sphere).chunks;
        EXPECT_EQ(here, std::set<ChunkId>(named.begin(), named.end())) << name_of(sphere);
    }
}

INSTANTIATE_TEST_SUITE_P(Generated, Regions, testing::ValuesIn(generated_meshes()), mesh_name);
INSTANTIATE_TEST_SUITE_P(WellKnown, Regions, testing::ValuesIn(smaller_known_meshes()), mesh_name);

} // namespace
} // namespace tactus::test
