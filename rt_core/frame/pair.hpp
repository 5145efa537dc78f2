// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/mesh_pair.hpp"
#include "rt_core/frame/model.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/predict/region_predictor.hpp"
#include "rt_core/query/block_search.hpp"
#include "rt_core/records/frame_variant.hpp"
#include "rt_core/refine/refine_question.hpp"
#include "rt_core/scene/outlook.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// What all pairs of a frame go by.
struct PairRules
{
    std::int64_t period_ns{1'000'000};
    std::int64_t pose_age_max_ns{0};
    Prediction prediction{Prediction::automatic};
    FrameVariant variant;
};

/// A model and its name in the frame.
struct NamedModel
{
    ModelId id{};
    const Model* model{nullptr};
};

/// Whom a pair brings together; all of it outlives the pair.
struct PairParts
{
    std::uint32_t tool_index{0};
    std::uint32_t object_index{0};
    const PairRules* rules{nullptr};
    const Tool* tool{nullptr};
    const ObjectSpec* object{nullptr};
    const ObjectPose* pose{nullptr}; ///< This frame's, whenever a function is called.
    NamedModel model;                ///< Of the object.
    NamedModel tool_model;           ///< Of a tool that is a mesh; none for other tools.
};

/// What pairs keep beside themselves, each at its own index. Empty where no tool needs it.
struct PairMemory
{
    std::span<LocalSurface> surfaces;
    std::span<ContactReport> contacts; ///< For tools that want them or are meshes.
    std::span<TouchReport> touches;    ///< For tools that are held as bodies.
    std::span<MeshPair> meshes;        ///< For tools that are meshes.

    [[nodiscard]] static PairMemory take(Arena& arena, std::span<const ToolSpec> tools,
                                         std::size_t pairs) noexcept;
};

/// What a pair asks of one model in a frame.
inline constexpr std::size_t kPairQuestions = std::size_t{2} * kMaxCoverBalls;
using RefineQuestions = StaticVector<RefineQuestion, kPairQuestions * kMaxPairs>;

/// One tool and one object: where they are to each other, and what is known of it from frame to
/// frame. Haptic thread; the functions in the frame's order. 2.5 KiB beside its parts.
class Pair
{
public:
    Pair() noexcept = default;
    Pair(const PairParts& parts, const PairMemory& memory, std::size_t index) noexcept;

    /// Fits the pair to where tool and object are in this frame.
    void place(const Budgets& budgets, FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// Adds what the pair may touch soon to the ranking, unless its models are here as a whole.
    void rank(RegionRanking& ranking) noexcept TACTUS_NONBLOCKING;

    /// What the pair asks of this model: where the tool is and, coming nearer, where it will be.
    /// Certificates of questions that it does not ask are forgotten: the model may coarsen there.
    void ask(ModelId model, RefineQuestions& questions) noexcept TACTUS_NONBLOCKING;

    /// The distance, and what the tool's force needs of the surface.
    void query(const Budgets& budgets, WorkCounters& work,
               FrameFault& faults) noexcept TACTUS_NONBLOCKING;

    /// The last frame's query into scratch memory; see Frame::rehearse().
    void rehearse(const Budgets& budgets, LocalSurface& scratch) const noexcept TACTUS_NONBLOCKING;

    /// What query() found, for the tool.
    [[nodiscard]] PlacedSurface placed() const noexcept TACTUS_NONBLOCKING;
    /// What query() found, for the caller of the frame.
    [[nodiscard]] PairOutput output() const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] PairMotion motion() const noexcept;
    void ask_for_balls(RefineQuestions& questions) noexcept;
    void ask_for_mesh(ModelId model, RefineQuestions& questions) noexcept;
    void ask(bool is_asked, const Model& model, const RefineQuestion& question,
             RefineQuestions& questions) const noexcept;
    void query_core(const Budgets& budgets, WorkCounters& work, FrameFault& faults) noexcept;
    void report_core() noexcept;
    void query_mesh(WorkCounters& work, FrameFault& faults) noexcept;
    [[nodiscard]] double rounding_m() const noexcept;

    PairParts parts_;
    LocalSurface* surface_{nullptr};
    ContactReport* contacts_{nullptr}; ///< Null unless the tool wants them or is a mesh.
    TouchReport* touches_{nullptr};    ///< Null unless the tool is held as a body.
    MeshPair* mesh_{nullptr};          ///< Null unless the tool is a mesh.
    Outlook outlook_;
    RegionPredictor predictor_;
    std::array<RefineMemory, kPairQuestions> refine_memories_{};
    QueryMemory query_memory_;
    /// The answer's bounds in the world, wider by what the way there may round.
    double lower_m_{0.0};
    double upper_m_{0.0};
};

} // namespace tactus
