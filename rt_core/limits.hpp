// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>

/// Every capacity of rt_core, every bound of a loop and every tolerance of a result: what it
/// bounds, its unit, the reason for the value, its cost, and the consequence of reaching it.
/// Nothing is dropped silently: input is refused, the answer reports less, or a FrameFault names
/// the limit.
///
/// Other constants are defined elsewhere, with unit and reason: those that affect only the speed or
/// the quality of one algorithm at the top of its source; rounding errors beside their arithmetic;
/// sizes of a layout in memory or in a file beside that. A test names each constant below and
/// checks both sides of it (guard.text).
// Any thread: constants.
namespace tactus
{

// --- The mesh format -----------------------------------------------------------------------------

/// Faces in one record's star, including the appearing ones. Costs 9 B a face in every record. A
/// limit of 8 costs no quality (design measurements), so larger stars are never collapsed. The
/// coded form has no more places, so a chunk can't bring a larger one.
inline constexpr std::uint32_t kMaxStarFaces = 8;
/// Fan faces of a star: all but A and B (a border star lacks one of those, its fan is not longer).
/// A chunk with a longer fan is refused.
inline constexpr std::uint32_t kMaxFanFaces = kMaxStarFaces - 2;

/// Largest record count: FaceState keeps the record in 29 bits, all ones meaning the base state. A
/// header with more is refused, as for all limits of this section unless stated otherwise.
inline constexpr std::uint32_t kMaxRecords = (1U << 29U) - 2;
/// Largest base mesh the controller accepts, in faces. Base faces are resident: about 150 B each.
inline constexpr std::uint32_t kMaxBaseFaces = 16'384;
/// Base vertices; separate triangles have three per face.
inline constexpr std::uint32_t kMaxBaseVertices = 3 * kMaxBaseFaces;
/// Dependency depth of a record (number of rounds of the encoder; 20 to 60 on real meshes). It
/// bounds the stacks over a closure, 4 B each: if merging finds none left, the record waits until
/// its page is checked again.
inline constexpr std::uint32_t kMaxDepth = 1'024;
/// Coordinates are integers of at most this many bits times the quantum, so exact in a float.
inline constexpr std::uint32_t kMinPositionBits = 16;
inline constexpr std::uint32_t kMaxPositionBits = 24;
static_assert(kMinPositionBits <= kMaxPositionBits);
static_assert(kMaxPositionBits <= 24, "a float's mantissa holds a coordinate exactly");

/// Places in a model's source frame are refused beyond this. A mesh in map coordinates is within;
/// one farther away could be touched nowhere (kGoalRange_m).
inline constexpr double kModelReachMax_m = 1e7;
/// Vertices of a hull are refused beyond this: differences would overflow.
inline constexpr double kCoordinateRange = 1e300;
/// The quantum is 2^-60 .. 2^20 m: from a micrometre-sized model at 24 bits to 10^6 m at 16.
inline constexpr std::int32_t kMinQuantumLog2 = -60;
inline constexpr std::int32_t kMaxQuantumLog2 = 20;
/// Cells of the regular partition: one bit each in the header, 32 KiB at most. The encoder refuses
/// more, too.
inline constexpr std::uint32_t kMaxRegions = 1U << 18U;
/// One coded chunk; about 550 B are usual. A reader may lend a buffer of this size and needs no
/// other. An index page that states a longer one is refused.
inline constexpr std::size_t kMaxCodedChunkBytes = 8'448;

// --- The scene -----------------------------------------------------------------------------------

/// Tools of one frame; 3 KiB each. Frame::start refuses more.
inline constexpr std::uint32_t kMaxTools = 16;
/// Objects in a scene at once, about 250 B each; their capacity is chosen when a frame starts,
/// which refuses more.
inline constexpr std::uint32_t kMaxObjects = 4'096;
/// Models that share the pools: 8 KiB each besides header and base mesh. The owner of a slot is
/// stored in one byte.
inline constexpr std::uint32_t kMaxModels = 256;
/// Pairs of a tool and a near object that are tracked at once: 5.3 KiB each, 3 KiB more with
/// contacts and 10 KiB more if a tool is a mesh. The nearest are tracked, and a tool goes no
/// farther than its clearance from the others: FrameFault::scene_over_capacity.
inline constexpr std::uint32_t kMaxPairs = 64;
/// Objects on the list of those near one tool, 4 B each. The nearest are listed, with the same
/// consequence.
inline constexpr std::uint32_t kMaxNear = 32;
/// Walks over all objects of a scene in one frame, each for one tool: 11 us for 4,096 objects, or
/// 43 us if all are near it. A tool that waits for its walk goes no farther than its known
/// clearance.
inline constexpr std::uint32_t kBroadWalks = 4;
/// Changes of the scene that a frame takes, 208 B each. Later ones of the same frame are refused:
/// ChangeRefusal::too_many.
inline constexpr std::uint32_t kMaxSceneChanges = 64;
/// Active faces of all models together: as many places as fit beside the owner's byte; 108 B each
/// with their part of the tree. Frame::start refuses pools with more.
inline constexpr std::uint32_t kMaxPoolFaces = (1U << 24) - 1;

/// Spheres that cover a tool's core, each a question to the refinement: around a capsule as long as
/// sixteen radii, refinement extends no farther than 2.5 radii from its axis. 370 B each for a
/// pair. A longer core has larger spheres, and a mesh's last spheres grow: more is refined than
/// needed.
inline constexpr std::uint32_t kMaxCoverSpheres = 8;

/// Sets of exact triangles in a frame, for pairs with up to kMaxLocalTriangles: the
/// highest-priority pairs are served first. 48 KiB each.
inline constexpr std::uint32_t kLocalSurfaces = 4;
/// Exact triangles of one pair for the force stage; 76 are usual at 1.1 M faces and a tool of 1 %
/// of the diagonal, 750 for a sphere of eight edges that moves four edges a frame. 48 B each. The
/// nearest are kept, at least seven eighths of them; the certified radius ends at the first one
/// left out, with FrameFault::surface_truncated.
inline constexpr std::uint32_t kMaxLocalTriangles = 1'024;

/// Contacts of one pair, the nearest ones; 96 B each. With more the report is marked incomplete. A
/// tool with a torque then feels the nearest (FrameFault::tool_over_capacity); it can't cross
/// the others, since its step ends at the proven distance.
inline constexpr std::uint32_t kMaxContacts = 32;
/// Pairs of meeting faces that are kept, for a tool that is a mesh and an object; 8 B each. With
/// more the report is marked truncated.
inline constexpr std::uint32_t kMaxMeetingFaces = 1'024;
/// Number of faces that meet a tool, or of pairs for a mesh tool without a list, after which the
/// search stops: the tool is deep in the object, and contacts give no exit direction. Two equal
/// meshes in one place have ten pairs a face, all of them for exact arithmetic. 161 were seen with
/// a tool of 980 faces half in the bunny of 69 k.
inline constexpr std::uint32_t kEnoughMeetingFaces = 256;
static_assert(kEnoughMeetingFaces > kMaxContacts && kEnoughMeetingFaces <= kMaxMeetingFaces);

// --- The frame -----------------------------------------------------------------------------------

/// Largest budgets that a caller may give (records/frame_input.hpp); scratch memory follows them. A
/// larger budget is cut to this: coarse faces that remain are reported as with any spent budget,
/// merges that remain only cost memory.
inline constexpr std::uint32_t kMaxSplitsPerFrame = 256;
inline constexpr std::uint32_t kMaxMergesPerFrame = 256;
/// Faces that wait to be split in one frame; 16 B each. Faces beyond it wait for the next frame, no
/// certificate reaches that far, and the frame reports FrameFault::refine_heap_full.
inline constexpr std::uint32_t kRefineHeap = 1'024;
/// Blocks with coarse faces near another surface that one search keeps; 72 B each. Beyond it faces
/// wait for the next frame, and no certificate reaches that far.
inline constexpr std::uint32_t kMaxNearBlocks = 64;
/// Records split for closures that are not complete yet, kept from being merged, of all models of a
/// frame; 8 B each. Records beyond it may be merged and split again: FrameFault::held_records_full.
inline constexpr std::uint32_t kMaxHeldRecords = 1'024;
static_assert(kMaxSplitsPerFrame <= kMaxHeldRecords, "one frame's splits can all be held");
/// Levels of nodes in the AB-Tree: octal digits of its 64-bit paths. No two faces have the same
/// path, so there can't be more.
inline constexpr std::uint32_t kTreeLevels = 22;
/// A traversal's stack: 7 siblings on each level and the 8 of the last node. A tree of kTreeLevels
/// needs no more; beyond it an assertion fails.
inline constexpr std::uint32_t kTreeStack = kTreeLevels * 7 + 8;
/// Traversals with full `nodes` and `triangles` that a frame does to refine, and as many to answer,
/// the highest-priority pairs first; a slide over 60,000 faces visits about 25 nodes a frame. Later
/// ones are cut short, with the bounds proven so far: FrameFault::node_budget_spent. Bounds the
/// frame for any scene.
inline constexpr std::uint32_t kFrameWalks = 8;
/// Factor on Budgets for one pair of a tool that is a mesh, which has thousands of faces near an
/// object where other tools are one shape. Beyond it: FrameFault::node_budget_spent.
inline constexpr std::uint32_t kMeshBudgetFactor = 16;
/// Factor on Budgets for refining such a pair, for either model, now and a little ahead. Faces that
/// were not reached are checked in the next frame, after the splits; until then they are coarse for
/// the query: FrameFault::node_budget_spent, too.
inline constexpr std::uint32_t kMeshRefineFactor = 4;
static_assert(kMeshRefineFactor < kMeshBudgetFactor, "what is coarse still can be asked about");
/// Spheres that the predictor ranks, 56 B each: five for each sphere of the pairs that are near.
/// Enough for a spherical tool in each pair, or four rigid tools of eight spheres. Predicted ones
/// of later pairs are dropped first, which only makes their chunks late, then those at a tool:
/// FrameFault::ranking_full.
inline constexpr std::uint32_t kMaxRankedRegions = 6 * kMaxPairs;
/// Resident index pages of a model with more of them, 772 B each; more are kept if memory allows,
/// and others are requested again when needed.
inline constexpr std::uint32_t kLeastResidentIndexPages = 192;
/// Requests under way while a whole model is loaded; further ones wait for answers. Requests of a
/// tool must not wait behind more of them, nor be dropped from the transport side's list.
inline constexpr std::uint32_t kMaxFillingRequests = 128;
/// Error of converting a point into a model's frame and back, as a share of its distance from the
/// object's origin and of its own coordinates. Each conversion rounds about seven times by 1.1e-16,
/// and R^T R of a rotation may be 2e-15 from the identity. Bounds are widened by it.
inline constexpr double kPoseRounding = 4e-15;
/// Error of a model's place due to the conversion from its source's pose, as a share of the
/// distance between both origins. Each coordinate rounds four times by 1.1e-16.
inline constexpr double kOriginRounding = 1e-15;
/// Distance from the origin, in quanta, from which a point is beyond the kernels: squares would
/// leave single precision, and the bounding box answers instead. A model has at most 2^24 quanta
/// per side.
inline constexpr double kFarQuanta = 0x1p36;
/// Frames after which an unanswered request is repeated.
inline constexpr std::uint32_t kRequestTimeoutFrames = 250;
/// The same as a time, for loops of any rate: longer than arrivals over a bad link take.
inline constexpr std::int64_t kRequestTimeout_ns = 250'000'000;

/// Arrivals taken from a model's queues in one frame, even if Budgets::pages is larger, and updates
/// of linked records; recordings keep them, 32 B each. An arrival brings few updates, each one word
/// to write; more wait for the next frame.
inline constexpr std::uint32_t kMaxArrivalsPerFrame = 64;
inline constexpr std::uint32_t kMaxLinkUpdatesPerFrame = 64;

/// Faces of base meshes that enter their trees in one frame, for all added models: 10 us.
inline constexpr std::uint32_t kEnteringFacesPerFrame = 128;
/// Faces that removed models take out of their trees in one frame, and page slots checked for
/// theirs.
inline constexpr std::uint32_t kLeavingFacesPerFrame = 512;
inline constexpr std::uint32_t kLeavingSlotsPerFrame = 256;

// --- Force ---------------------------------------------------------------------------------------

/// Steps of the proxy in one frame: each ends where another triangle takes over. 2 to 6 are usual.
/// After the last one it is `under_way` and continues in the next frame.
inline constexpr std::uint32_t kProxySteps = 24;
/// Share of the tool's radius below which a motion isn't worth a step, and the proxy is at rest:
/// 0.1 uN at 500 N/m and 2 mm.
inline constexpr double kLeastStep = 1e-7;
/// The same where friction holds, and the accepted error of a slip: any place in the cone is at
/// rest, so none is better. 0.1 mN at 500 N/m and 2 mm.
inline constexpr double kSlipShare = 1e-4;
/// Distance, as a share of the tool's radius, within which triangles touch it: they press, cause
/// friction and may hold. Larger than a step, or triangles just ahead would shorten it to nothing.
inline constexpr double kTouchShare = 1e-4;
/// Batches of eight triangles that the proxy moves among: 226 B per batch on the stack. With more
/// in reach the farthest batches are left out, and the proxy goes no farther than they are away: it
/// is `under_way`.
inline constexpr std::uint32_t kMaxNearBatches = 144;
/// Times that a step is solved again with the triangle that it would enter; 2 or 3 are usual. A
/// triangle that is still entered shortens the step, and the next one begins there. No step is
/// shortened to nothing: touching triangles are among the planes from the first, and the others are
/// kTouchShare away. First contact with friction is found from as many faces in the path, each
/// checked; beyond them from planes seen from afar, in a shorter step.
inline constexpr std::uint32_t kStepRounds = 16;
/// Largest penetration of the surface into the tool's radius, relative to that radius, that still
/// counts as contact; a deeper surface counts as entered.
inline constexpr double kContactTolerance = 1e-6;
/// Planes that hold back one motion; 5 us in six dimensions with all of them. Beyond it those that
/// hold a tool back least are left out, or a sphere's later ones, from its force only:
/// FrameFault::tool_over_capacity.
inline constexpr std::uint32_t kMaxHalfSpaces = 64;
/// Faces checked in double where the proxy stops, to find its contacts, and, if Budgets::planes are
/// used up, as many to find how far a step is free; 300 instructions each. With more near a sphere,
/// it feels those that were checked (FrameFault::tool_over_capacity), and a step keeps the
/// length that single precision proves.
inline constexpr std::uint32_t kMaxTouchLooks = 4 * kMaxHalfSpaces;
/// Steps of a search for the nearest motion, each of which adds or removes a plane. Awkward planes
/// took 72 in the worst of a million searches; after half of the steps kSqueezeTolerance is enough.
/// After all of them no motion counts as allowed: the tool is `over_constrained`.
inline constexpr std::uint32_t kConstraintRounds = 128;
/// Distance by which a motion may exceed a plane, relative to the lengths of the problem.
inline constexpr double kPlaneTolerance = 1e-12;
/// Sine below which the normals of planes count as dependent: the space between two such planes
/// that face each other is a gap, not a wedge with an edge far away.
inline constexpr double kParallelPlanes = 1e-7;
/// Share of the lengths by which a gap between planes must be too narrow to count as
/// over-constrained.
inline constexpr double kSqueezeTolerance = 1e-6;
/// Faces round a sphere that its force shading averages, 300 instructions each at a stop. With more
/// within the width, the width is reduced; beside such faces it stays.
inline constexpr std::uint32_t kMaxShadedFaces = 64;
/// Range of the width over which a tool's force shading averages.
inline constexpr double kShadingWidthMin_m = 1e-4;
inline constexpr double kShadingWidthMax_m = 0.1;
/// Radius, in quanta, of a tool without a radius, so that it has an outside.
inline constexpr double kPointSkin = 0.25;
/// Past contact points kept while a tool rests, 88 B each. Six planes suffice to hold a rigid tool;
/// the others are candidates. Beyond it the oldest is dropped: FrameFault::tool_over_capacity.
inline constexpr std::uint32_t kMaxHolds = 16;
/// Share of its core's radius that a tool without a radius keeps as a skin, so that it can slide.
inline constexpr double kLeastSkin = 0.002;
/// Time in which ForceFader fades a force to zero, in seconds.
inline constexpr double kFadeTime_s = 0.05;
/// Rate at which the force of a proxy that waited for data catches up: this share of the device's
/// largest force or torque per second, but no more than the newtons below. At 1 kHz 0.8 % and 0.04
/// N a frame.
inline constexpr double kCatchUpShare_per_s = 8.0;
inline constexpr double kCatchUp_n_per_s = 40.0;
/// Time in which a force returns, in seconds: slower than it faded, so that an intermittent cause
/// leaves little force.
inline constexpr double kRiseTime_s = 0.1;
/// Share of the speed limit below which the force returns after the device was too fast.
inline constexpr double kCalmSpeedShare = 0.5;
/// Rotation speed, in rad/s, above which the device gets no torque and no force, and its motion
/// counts for no energy: a wrist reaches 30.
inline constexpr double kRotationMax_rad_per_s = 60.0;
/// Largest damping while a force fades or returns, as a share of the device's largest force.
inline constexpr double kDampingForceShare = 0.25;
/// Largest change of a force by coarser faces while the pools have room for finer ones, in newtons:
/// a tenth of the force change at a wall that a user feels.
inline constexpr double kForceToleranceMax_n = 0.1;
/// The same unless an option sets it: imperceptible.
inline constexpr double kForceToleranceUsual_n = 0.001;
/// Rate at which a force may change beyond the motion of device and objects, as a share of the
/// device's largest force per millisecond, unless an option sets it: 0.08 N for 8 N. A strike thus
/// rises in 100 ms, about as fast as a hand yields. Never below the least, or no force would rise.
inline constexpr double kSlewShare_per_ms = 0.01;
inline constexpr double kSlewShareMin_per_ms = 1e-4;
/// Time, in seconds, for which a force must want to change faster before ForceOff::growth is
/// reported.
inline constexpr double kChangeTold_s = 0.02;
/// Share of a device's own damping that may be added by computation. A sampled damper of b on a
/// device with damping B stays passive while b + k T / 2 < B (Colgate and Schenkel 1997), k being
/// the wall's stiffness and T the period; half leaves the other half to the wall.
inline constexpr double kDampingShare = 0.5;

// --- Stability (docs/stability.md) ---------------------------------------------------------------

/// Share of the predicted limit that a wall's stiffness may reach. Covers fractions of a period in
/// the delay (8 %) and a device's damping that is known to 10 %.
inline constexpr double kStiffnessMargin = 0.9;
/// Positions used to estimate a velocity; 16 at 1 kHz resolve 1/16 of a quantum per period. 32 B
/// each. Older ones are dropped: the velocity is that of the newest.
inline constexpr std::uint32_t kVelocitySamples = 16;
/// Forces kept that may still be under way to the device, 32 B each: enough for a delay of nine
/// periods. With a longer one the oldest kept replaces those before it, so the energy is that of a
/// force newer than the device's: ForceAction::blind.
inline constexpr std::uint32_t kForcesUnderWay = 10;
/// Device speed above which the device has jumped: its energy is not observed (ForceAction::blind).
/// A hand reaches 10 m/s at most.
inline constexpr double kDeviceSpeedMax_m_per_s = 10.0;
/// Force of a damping, in newtons, up to which it isn't added: the rounding of a tool at rest.
inline constexpr double kLeastDamping_n = 1e-3;

// --- Convex tools --------------------------------------------------------------------------------

/// Vertices of a convex hull. Each answer needs a few support points, each a check of all vertices,
/// 2 ns per vertex; a rounder tool than 64 vertices allow is given by a support function. A hull
/// with more is refused.
inline constexpr std::uint32_t kMaxHullVertices = 64;
/// Support points that one distance of a convex body and a triangle computes. Hulls need 4 as a
/// rule and 15 at most in two million cases; curved bodies that nearly touch end here, with valid
/// but wider bounds.
inline constexpr std::uint32_t kGjkIterations = 64;
/// Share of the distance below which the difference of bounds is small enough.
inline constexpr double kGjkRelativeGap = 1e-12;
/// Faces round a vertex that its normal averages, 16 B each on the stack. With more the normal is
/// zero, which means unknown.
inline constexpr std::uint32_t kMaxIncidentFaces = 64;

// --- Poses of objects and of devices -------------------------------------------------------------

/// Ranges of `--place`, a host's pose and a device frame: each coordinate of the translation,
/// either sign, and the scale.
inline constexpr double kPoseReachMax_m = 1e4;
inline constexpr double kPoseScaleMin = 1e-3;
inline constexpr double kPoseScaleMax = 1e3;
/// Ranges of a material: larger values are unphysical and would leave the range of results computed
/// from them.
inline constexpr double kFrictionMax = 1e3;
inline constexpr double kDampingMax_n_s_per_m = 1e9;
/// Length of a texture's bumps, and their height as a share of it. Steeper ones would make a wall
/// more than 1.2 times as stiff as specified, and could pull: docs/stability.md. Other materials
/// are ChangeRefusal::bad_material.
inline constexpr double kTextureLengthMin_m = 1e-4;
inline constexpr double kTextureLengthMax_m = 1.0;
inline constexpr double kTextureSteepest = 0x1p-5;
/// Time in which a changed material becomes the new one during contact: fifty steps at 1 kHz, each
/// of which changes a wall's force by a fiftieth of the new stiffness's effect.
inline constexpr double kMaterialBlend_s = 0.05;
/// Deviation of R^T R from the identity, per entry, up to which a tool's or a device frame's
/// rotation is made orthonormal. Beyond it a sample is FrameFault::tool_invalid, a device frame
/// refused.
inline constexpr double kRotationTolerance = 1e-6;
/// Deviation of a host's quaternion from length 1. Wider than kRotationTolerance, as senders may
/// compute in float; its length is divided out.
inline constexpr double kPoseUnitTolerance = 1e-3;

// --- Samples of the device -----------------------------------------------------------------------

/// Bound on each coordinate of device positions and goals. Wider than kPoseReachMax_m, as a device
/// frame scales and moves the device's values; beyond any device and any model. Others are
/// FrameFault::tool_invalid.
inline constexpr double kGoalRange_m = 1e6;
/// Time for which the last sample replaces missing or unusable ones. 20 periods of a loop at 1 kHz;
/// then the force fades within kFadeTime_s (FrameFault::tool_stuck, if the device's time does not
/// advance).
inline constexpr double kSampleHold_s = 0.02;
/// Speed of a goal, in ToolSpec::speed_max_m_per_s of at least 1 m/s, above which it has jumped
/// (FrameFault::tool_jumped): a hand reaches 10 m/s at most.
inline constexpr double kJumpSpeeds = 100.0;
/// Rotation speed of a goal, in rad/s, above which it has jumped: at 1 kHz 57 degrees in one frame.
inline constexpr double kJumpRotation_rad_per_s = 1'000.0;

// --- Names ---------------------------------------------------------------------------------------

/// A model's or tool's name: at most this many bytes of UTF-8. A longer one is refused.
inline constexpr std::size_t kMaxNameBytes = 63;

} // namespace tactus
