// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/simplify.hpp"

#include "host_tools/simplify/absorption.hpp"
#include "host_tools/simplify/boundary_quadrics.hpp"
#include "host_tools/simplify/candidates.hpp"
#include "host_tools/simplify/certificate.hpp"
#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/parallel_blocks.hpp"
#include "host_tools/simplify/surface_samples.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace tactus
{

namespace
{

/// Share of a round's candidates that are taken, best first. Smaller rounds give a better base and
/// a deeper forest (30 % gives 26 to 38 rounds to 1 %).
constexpr double kTakenShare = 0.3;
/// A round starves if it has fewer than one candidate for this number of remaining vertices. It
/// then also takes candidates of higher spoil levels.
constexpr std::size_t kStarvedShare = 64;
/// Share of the faces left, below which Priority::measured replaces Priority::quadric.
constexpr double kMeasuredShare = 0.3;

/// Number of rounds between checks whether the remaining rounds suffice at the present pace. Meshes
/// that reach their base need fewer rounds in all.
constexpr std::uint32_t kPaceRounds = 64;

constexpr unsigned kMaxThreads = 256;
constexpr std::size_t kVertexBlock = 256;
constexpr std::size_t kStarBlock = 32;

/// Executes rounds of collapses with disjoint stars.
///
/// A round finds each vertex's best collapse in the present mesh, sorts the best of these and
/// executes them one after another. It skips a collapse whose star was touched in this round, or
/// that an earlier collapse made illegal. The result *is* thus a sequential execution. Costs depend
/// on the star alone and therefore stay valid; only the link condition and the degree depend on
/// more. Disjoint stars commute, so any dependency-closed cut is again a legal sequential
/// execution. Finding candidates and re-assigning pieces run in parallel; neither reads data that
/// another vertex or star of the same phase writes. Candidates are ordered by cost and vertex, so
/// the result does not depend on threads.
class Simplifier
{
public:
    Simplifier(const QuantisedMesh& mesh, const SimplifyOptions& options, CollapseMesh current)
        : mesh_(mesh)
        , options_(options)
        , current_(std::move(current))
        , boundary_(mesh, current_)
        , certificate_(mesh, options.threads)
        , candidates_(mesh.positions.size())
        , stale_(mesh.positions.size(), 1)
        , touched_(mesh.faces.size(), 0)
        , components_(count_components(current_))
        , paced_faces_(current_.faces_left())
        , scratch_(options.threads)
    {
        result_.collapses.reserve(mesh.positions.size());
        result_.is_closed = current_.is_closed();
    }

    Result<Simplification, Refusal> run();

private:
    void measure_from_now_on();
    void find_candidates();
    void pick_candidates();
    void collapse_disjoint();
    [[nodiscard]] bool is_hopeless() noexcept;
    [[nodiscard]] bool is_untouched(const VertexRing& ring) const noexcept;
    bool absorb_components();
    [[nodiscard]] double allowed_absorption_cost();
    void finish(const Absorption& absorption);
    void execute(const Star& star);
    void mark_stale(const Star& star);
    void note(const Star& star);
    void end_round();
    void certify(const Star& star, unsigned worker);
    void collect_base();

    const QuantisedMesh& mesh_;
    const SimplifyOptions& options_;
    CollapseMesh current_;
    BoundaryQuadrics boundary_;
    Certificate certificate_;
    SurfaceSamples samples_; ///< Maintained once the measured error ranks the candidates.
    std::vector<Candidate> candidates_; ///< Candidate by vertex.
    std::vector<std::uint8_t> stale_;   ///< Flags by vertex: the candidate must be found again.
    std::vector<Candidate> picked_;     ///< Candidates of this round.
    Priority priority_{Priority::quadric};
    std::vector<std::uint8_t> touched_; ///< Flags by face: 1 if a star of this round has the face.
    std::vector<Star> round_;           ///< Stars of this round.
    std::size_t components_;
    std::size_t stuck_faces_{0}; ///< Faces in components that cannot shrink, in the round before.
    double cheapest_absorption_{0}; ///< Cost of the cheapest absorption not executed.
    std::uint32_t paced_rounds_{0}; ///< Round from which the pace is measured.
    std::size_t paced_faces_;       ///< Faces left in that round.
    bool is_hopeless_{false};
    std::vector<CandidateScratch> scratch_;
    Simplification result_;
};

Result<Simplification, Refusal> Simplifier::run()
{
    while (current_.faces_left() > options_.base_faces && result_.rounds < kMaxDepth)
    {
        if (options_.progress && !options_.progress(current_.faces_left(), mesh_.faces.size()))
        {
            return Refusal{"cancelled with " + std::to_string(current_.faces_left()) + " of " +
                           std::to_string(mesh_.faces.size()) + " faces left"};
        }
        find_candidates();
        pick_candidates();
        if (is_hopeless())
        {
            break;
        }
        if (components_ > 1 && absorb_components())
        {
            continue;
        }
        if (picked_.empty())
        {
            break;
        }
        collapse_disjoint();
        end_round();
    }
    collect_base();
    return std::move(result_);
}

/// True if the remaining rounds do not suffice at the present pace, for example if few of many
/// pieces at one place vanish in each round.
bool Simplifier::is_hopeless() noexcept
{
    const std::size_t rounds = result_.rounds - paced_rounds_;
    if (rounds >= kPaceRounds)
    {
        const std::size_t left = current_.faces_left() - options_.base_faces;
        const std::size_t removed = paced_faces_ - current_.faces_left();
        is_hopeless_ = is_hopeless_ || removed * (kMaxDepth - result_.rounds) < left * rounds;
        paced_rounds_ = result_.rounds;
        paced_faces_ = current_.faces_left();
    }
    return is_hopeless_;
}

void Simplifier::measure_from_now_on()
{
    priority_ = Priority::measured;
    std::ranges::fill(stale_, std::uint8_t{1});
    const std::vector<std::uint32_t> present = current_.present_faces();
    samples_.start(present, mesh_.faces.size());
    parallel_blocks(options_.threads, present.size(), kVertexBlock,
                    [&](unsigned worker, std::size_t begin, std::size_t end)
                    {
                        for (std::size_t i = begin; i < end; ++i)
                        {
                            samples_.set(present[i], certificate_.sample(present[i], worker));
                        }
                    });
}

/// Finds candidates of vertices whose star has changed, and of those without one, since the link
/// condition depends on more than the star.
void Simplifier::find_candidates()
{
    const bool few_faces = static_cast<double>(current_.faces_left()) <
                           kMeasuredShare * static_cast<double>(mesh_.faces.size());
    if (few_faces && priority_ == Priority::quadric)
    {
        measure_from_now_on();
    }
    const CandidateInput input{mesh_, current_, boundary_, samples_, priority_};
    const auto find_block = [&](unsigned worker, std::size_t begin, std::size_t end)
    {
        for (std::size_t v = begin; v < end; ++v)
        {
            if (stale_[v] != 0 || candidates_[v].parent == Candidate::kNone)
            {
                candidates_[v] =
                    find_candidate(input, static_cast<std::uint32_t>(v), scratch_[worker]);
                stale_[v] = 0;
            }
        }
    };
    parallel_blocks(options_.threads, candidates_.size(), kVertexBlock, find_block);
}

/// Takes the best share of the candidates, sorted, from the lowest spoil levels that do not starve
/// the round.
void Simplifier::pick_candidates()
{
    picked_.clear();
    std::array<std::size_t, kSpoilLevels> count{};
    for (const Candidate& candidate : candidates_)
    {
        if (candidate.parent != Candidate::kNone)
        {
            picked_.push_back(candidate);
            ++count[static_cast<std::size_t>(candidate.spoils)];
        }
    }
    const std::size_t enough = 1 + current_.vertices_left() / kStarvedShare;
    std::size_t available = 0;
    for (std::size_t level = 0; level < kSpoilLevels && available < enough; ++level)
    {
        available += count[level];
    }
    const auto taken = static_cast<std::size_t>(kTakenShare * static_cast<double>(available));
    const std::size_t size = std::min(available, taken + 1);
    const auto end = picked_.begin() + static_cast<std::ptrdiff_t>(size);
    std::nth_element(picked_.begin(), end, picked_.end());
    std::sort(picked_.begin(), end);
    picked_.resize(size);
}

/// Executes the picked collapses with disjoint stars. If an earlier collapse, of this round or
/// before, has made a candidate illegal, the vertex gets a new one for the next round. The first
/// candidate skipped this way is therefore replaced or removed, so a round without collapses cannot
/// repeat forever.
void Simplifier::collapse_disjoint()
{
    std::ranges::fill(touched_, std::uint8_t{0});
    round_.clear();
    for (const Candidate& candidate : picked_)
    {
        if (current_.faces_left() <= options_.base_faces)
        {
            return;
        }
        VertexRing ring;
        if (!current_.gather_ring(candidate.vertex, ring) || !is_untouched(ring))
        {
            continue;
        }
        std::uint32_t place = 0;
        while (ring.parent_at(place) != candidate.parent)
        {
            ++place;
        }
        const Star star = star_at(ring, place);
        if (current_.is_legal(star))
        {
            execute(star);
        }
        else
        {
            stale_[candidate.vertex] = 1;
        }
    }
}

bool Simplifier::is_untouched(const VertexRing& ring) const noexcept
{
    return std::none_of(ring.faces.begin(), ring.faces.begin() + ring.face_count,
                        [&](std::uint32_t face) { return touched_[face] != 0; });
}

/// Maximum cost of an absorption: the cost of the worst collapse picked for this round. It is
/// unlimited if components that cannot shrink outnumber the others or keep the mesh above its base.
/// Negative if no absorption can be that cheap.
double Simplifier::allowed_absorption_cost()
{
    const std::size_t stuck = count_stuck_faces(current_);
    const bool has_new = stuck > std::exchange(stuck_faces_, stuck);
    if (stuck > 0 && (picked_.empty() || 2 * stuck >= current_.faces_left()))
    {
        return std::numeric_limits<double>::infinity();
    }
    const bool is_worth_a_look =
        stuck > 0 && (has_new || picked_.back().cost >= cheapest_absorption_);
    return is_worth_a_look ? picked_.back().cost : -1;
}

/// Absorbs components. Each step of the absorptions counts as one round of the result. False if
/// nothing was absorbed.
bool Simplifier::absorb_components()
{
    const double cost_max = allowed_absorption_cost();
    if (cost_max < 0 || result_.rounds + Absorption::kStepsMax > kMaxDepth)
    {
        return false;
    }
    const AbsorptionPlan plan = plan_absorptions(
        mesh_, current_, current_.faces_left() - options_.base_faces, cost_max, options_.threads);
    const std::vector<Absorption>& absorptions = plan.absorptions;
    cheapest_absorption_ = plan.cost_left;
    for (std::size_t step = 0; step < Absorption::kStepsMax; ++step)
    {
        round_.clear();
        for (const Absorption& absorption : absorptions)
        {
            if (step < absorption.steps.size())
            {
                note(absorption.steps[step]);
            }
        }
        end_round();
    }
    for (const Absorption& absorption : absorptions)
    {
        finish(absorption);
    }
    components_ -= absorptions.size();
    return !absorptions.empty();
}

void Simplifier::finish(const Absorption& absorption)
{
    if (absorption.steps.size() == Absorption::kStepsMax)
    {
        current_.collapse(absorption.steps[0]);
    }
    const Star& last = absorption.steps[absorption.steps.size() - 1];
    current_.absorb(last);
    boundary_.replace(last.vertex, last.parent);
    for (const Star& star : absorption.steps)
    {
        candidates_[star.vertex].parent = Candidate::kNone;
    }
    mark_stale(last);
}

void Simplifier::execute(const Star& star)
{
    note(star);
    const bool closes_hole = current_.face_across_hole(star) != Collapse::kNoFace;
    current_.collapse(star);
    boundary_.collapse(star.vertex, star.parent);
    if (closes_hole)
    {
        boundary_.release(star.parent);
        boundary_.release(star.open_end());
    }
    candidates_[star.vertex].parent = Candidate::kNone;
    mark_stale(star);
}

void Simplifier::mark_stale(const Star& star)
{
    for (std::uint32_t i = 0; i <= star.fan_size; ++i)
    {
        stale_[star.rim[i]] = 1;
    }
    stale_[star.parent] = 1;
}

/// Adds the star to the round and to the result.
void Simplifier::note(const Star& star)
{
    round_.push_back(star);
    Collapse collapse{star.vertex, star.parent, result_.rounds, star.fan_size, {}, {}};
    collapse.star.fill(Collapse::kNoFace);
    for (std::uint32_t place = 0; place < 2 + star.fan_size; ++place)
    {
        const std::uint32_t face = star.faces[place];
        collapse.star[place] = face;
        if (face != Collapse::kNoFace)
        {
            touched_[face] = 1;
            collapse.error[place] = certificate_.error(face);
        }
    }
    result_.collapses.push_back(collapse);
}

void Simplifier::end_round()
{
    parallel_blocks(options_.threads, round_.size(), kStarBlock,
                    [&](unsigned worker, std::size_t begin, std::size_t end)
                    {
                        for (std::size_t i = begin; i < end; ++i)
                        {
                            certify(round_[i], worker);
                        }
                    });
    result_.rounds += round_.empty() ? 0U : 1U;
}

void Simplifier::certify(const Star& star, unsigned worker)
{
    certificate_.reassign(star, worker);
    if (priority_ == Priority::measured)
    {
        for (const std::uint32_t face : std::span{star.faces}.subspan(2, star.fan_size))
        {
            samples_.set(face, certificate_.sample(face, worker));
        }
    }
}

void Simplifier::collect_base()
{
    result_.base_faces = current_.present_faces();
    for (const std::uint32_t face : result_.base_faces)
    {
        result_.base_corners.push_back(current_.corners(face));
        result_.base_error.push_back(certificate_.error(face));
    }
}

std::optional<Refusal> find_bad_option(const SimplifyOptions& options)
{
    if (options.base_faces == 0)
    {
        return Refusal{"base_faces is 0; it must be 1 or more"};
    }
    if (options.threads == 0 || options.threads > kMaxThreads)
    {
        return Refusal{"threads is " + std::to_string(options.threads) + "; allowed are 1 to " +
                       std::to_string(kMaxThreads)};
    }
    return std::nullopt;
}

} // namespace

Result<Simplification, Refusal> simplify(const QuantisedMesh& mesh, const SimplifyOptions& options)
{
    if (auto bad = find_bad_option(options))
    {
        return std::move(*bad);
    }
    auto current = CollapseMesh::create(mesh);
    if (!current)
    {
        return current.error();
    }
    return Simplifier(mesh, options, std::move(current).value()).run();
}

} // namespace tactus
