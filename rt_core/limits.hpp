// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>

/// Every capacity of rt_core, every bound of a loop and every tolerance of a result: what it
/// bounds, its unit, why this value, what it costs, and what happens where it is reached. Nothing
/// is given up in silence: input is refused, the answer says less, or a FrameFault names the limit.
///
/// Elsewhere stand, named, with unit and reason: what changes only the speed or the quality of one
/// algorithm, at the top of its source; the rounding errors of some arithmetic, beside it; sizes
/// that follow from a layout in memory or in a file, beside that. A test names each constant below
/// and stands on both sides of it (guard.text).
// Any thread: constants.
namespace tactus
{

// --- The mesh format -----------------------------------------------------------------------------

/// Faces in one record's star, the appearing ones included. Costs 9 B a face in every record;
/// a cap of 8 costs no quality (design measurements), so larger stars are never collapsed. The
/// coded form has no more places, so a chunk can't bring a larger one.
inline constexpr std::uint32_t kMaxStarFaces = 8;
/// Fan faces of a star: all but A and B (a border star misses one of those, its fan is not longer).
/// A chunk with a longer fan is refused.
inline constexpr std::uint32_t kMaxFanFaces = kMaxStarFaces - 2;

/// Largest record count: FaceState keeps the record in 29 bits, all ones meaning the base state. A
/// header with more is refused, as with all of this section where nothing else is said.
inline constexpr std::uint32_t kMaxRecords = (1U << 29U) - 2;
/// Largest base mesh the controller accepts, in faces. Base faces are resident: about 150 B each.
inline constexpr std::uint32_t kMaxBaseFaces = 16'384;
/// Base vertices; a soup of single triangles has three a face.
inline constexpr std::uint32_t kMaxBaseVertices = 3 * kMaxBaseFaces;
/// Dependency depth of a record (number of rounds of the encoder; 20 to 60 on real meshes).
/// It bounds the stacks over a closure, 4 B each: where merging finds none left, the record waits
/// until its page is looked at again.
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
/// One coded chunk; about 550 B are usual. A reader may lend a buffer of this size and need no
/// other. An index page that states a longer one is refused.
inline constexpr std::size_t kMaxCodedChunkBytes = 8'448;

// --- The scene -----------------------------------------------------------------------------------

/// Tools of one frame; 3 KiB each. Frame::start refuses more.
inline constexpr std::uint32_t kMaxTools = 16;
/// Objects that a scene may have at once, some 250 B each; their capacity is chosen when a frame
/// starts, which refuses more.
inline constexpr std::uint32_t kMaxObjects = 4'096;
/// Models that share the pools: 8 KiB each beside their header and base mesh. A byte says whose a
/// slot is.
inline constexpr std::uint32_t kMaxModels = 256;
/// Pairs of a tool and an object near it that are followed at once: 5.3 KiB each, 3 KiB more with
/// contacts and 10 KiB more where a tool is a mesh. Of more the nearest are followed, and a tool
/// goes no farther than it is clear of the others: FrameFault::scene_crowded.
inline constexpr std::uint32_t kMaxPairs = 64;
/// Objects on the list of those near one tool, 4 B each. Of more the nearest are listed, likewise.
inline constexpr std::uint32_t kMaxNear = 32;
/// Looks at all objects of a scene in one frame, each for one tool: of 4,096 objects 11 us, or 43
/// us where all are near it. A tool that waits for its own goes no farther than it is known to be
/// clear.
inline constexpr std::uint32_t kBroadWalks = 4;
/// Changes of the scene that a frame takes, 208 B each. Later ones of the same frame are refused:
/// ChangeRefusal::too_many.
inline constexpr std::uint32_t kMaxSceneChanges = 64;
/// Active faces of all models together: beside the owner's byte there are so many places; 108 B
/// each with their part of the tree. Frame::start refuses pools with more.
inline constexpr std::uint32_t kMaxPoolFaces = (1U << 24) - 1;

/// Balls that a tool's core is covered with, each a question to the refinement: around a capsule
/// as long as sixteen radii no farther than 2.5 radii from its axis is refined. 370 B each for a
/// pair. A longer core has larger balls, and one of a mesh's grows: more is refined than needed.
inline constexpr std::uint32_t kMaxCoverBalls = 8;

/// Room for exact triangles of a frame, in pairs with kMaxLocalTriangles: the most urgent pairs
/// take what they need first. 48 KiB each.
inline constexpr std::uint32_t kLocalSurfaces = 4;
/// Exact triangles handed to the force stage for one pair; 76 are usual at 1.1 M faces and a tool
/// of 1 % of the diagonal, 750 for a ball of eight edges that moves four edges a frame. 48 B each.
/// Of more the nearest are kept, seven eighths of them at least; the certified radius ends at the
/// first one left out, and the frame says FrameFault::surface_truncated.
inline constexpr std::uint32_t kMaxLocalTriangles = 1'024;

/// Contacts of one pair, the nearest ones; 96 B each. With more the report is not complete and says
/// so. A tool with a torque then feels the nearest (FrameFault::tool_crowded); it can't cross what
/// was left out, since its step ends at the proven distance.
inline constexpr std::uint32_t kMaxContacts = 32;
/// Pairs of faces that meet and are kept, of a tool that is a mesh and an object; 8 B each. With
/// more the report says that it is truncated.
inline constexpr std::uint32_t kMaxMeetingFaces = 1'024;
/// So many faces that meet a tool, or pairs of a mesh tool that wants none of them listed, are
/// enough: it lies deep in the object, and no contact tells a way out. Two equal meshes in one
/// place have ten pairs a face, all of them for exact arithmetic. 161 were seen where a tool of 980
/// faces lies half in the bunny of 69 k.
inline constexpr std::uint32_t kEnoughMeetingFaces = 256;
static_assert(kEnoughMeetingFaces > kMaxContacts && kEnoughMeetingFaces <= kMaxMeetingFaces);

// --- The frame -----------------------------------------------------------------------------------

/// Largest budgets that a caller may give (records/frame_input.hpp); scratch memory follows them.
/// Of a larger one this much is used: what is left coarse is told as with any spent budget, what is
/// left to merge only costs room.
inline constexpr std::uint32_t kMaxSplitsPerFrame = 256;
inline constexpr std::uint32_t kMaxMergesPerFrame = 256;
/// Faces that wait to be split in one frame; 16 B each. Faces beyond it wait for the next frame,
/// no certificate reaches that far, and the frame says FrameFault::refine_heap_full.
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
/// Traversals of a full `nodes` and `triangles` that a frame does to refine, and as many to answer,
/// the most urgent pairs first; a slide over 60,000 faces visits some 25 nodes a frame. Later ones
/// are cut short, with what is proven until there: FrameFault::node_budget_spent. Bounds the frame
/// whatever the scene.
inline constexpr std::uint32_t kFrameWalks = 8;
/// A tool that is a mesh has thousands of faces near an object where another is one shape: a query
/// may look at this many times what Budgets says for a pair. Then FrameFault::node_budget_spent.
inline constexpr std::uint32_t kMeshBudgetFactor = 16;
/// To refine the two it may look at so many times that at most, for either model, now and a little
/// ahead. What was not come to is looked at in the next frame, when what was is split; until then
/// it is coarse for the query: FrameFault::node_budget_spent, too.
inline constexpr std::uint32_t kMeshRefineFactor = 4;
static_assert(kMeshRefineFactor < kMeshBudgetFactor, "what is coarse still can be asked about");
/// Balls that the predictor ranks, 56 B each: five for each ball of the pairs that are near. Enough
/// for a sphere in each pair, or four bodies of eight balls. Of later pairs those are left out that
/// look ahead, which only makes their chunks late, and then those where the tool is:
/// FrameFault::ranking_full.
inline constexpr std::uint32_t kMaxRankedRegions = 6 * kMaxPairs;
/// A model with more index pages, 772 B each, keeps this many, or more where there is memory;
/// others are asked for again when they are needed.
inline constexpr std::uint32_t kLeastResidentIndexPages = 192;
/// Wishes under way while a whole model is loaded; more wait for answers. What a tool needs must
/// not wait behind more of them, nor be pushed out of what the transport side remembers.
inline constexpr std::uint32_t kMaxFillingWishes = 128;
/// What a point's way into a model's frame and back may be off by: a share of its distance from the
/// object's origin and of its own coordinates. Each way rounds some seven times by 1.1e-16, and
/// R^T R of a rotation may be 2e-15 from the identity. Bounds are widened by it.
inline constexpr double kPoseRounding = 4e-15;
/// What a model's place may be off by because its pose is its source's: a share of how far the
/// model's origin lies from the source's. Each coordinate rounds four times by 1.1e-16.
inline constexpr double kOriginRounding = 1e-15;
/// A point this far from the origin or farther, in quanta, is beyond the kernels: their squares
/// would leave single precision, and the box of everything answers. A model has at most 2^24 quanta
/// a side.
inline constexpr double kFarQuanta = 0x1p36;
/// Frames after which an unanswered wish is asked again.
inline constexpr std::uint32_t kWishTimeoutFrames = 250;
/// The same as a time, for loops of any rate: longer than arrivals over a bad link take.
inline constexpr std::int64_t kWishTimeout_ns = 250'000'000;

/// Arrivals taken from a model's door in one frame, whatever Budgets::pages says, and updates of
/// linked records; what a frame took is kept for recordings, 32 B each. An arrival brings few
/// updates, each one word to write; more wait for the next frame.
inline constexpr std::uint32_t kMaxArrivalsPerFrame = 64;
inline constexpr std::uint32_t kMaxLinkUpdatesPerFrame = 64;

/// Faces of base meshes that enter their trees in one frame, of all models that come: 10 us.
inline constexpr std::uint32_t kEnteringFacesPerFrame = 128;
/// Faces that models which go take out of their trees in one frame, and page slots that are looked
/// at for theirs.
inline constexpr std::uint32_t kLeavingFacesPerFrame = 512;
inline constexpr std::uint32_t kLeavingSlotsPerFrame = 256;

// --- Force ---------------------------------------------------------------------------------------

/// Steps of the proxy in one frame: each ends where another triangle takes over. 2 to 6 are usual.
/// After the last it is `under_way` and goes on in the next frame.
inline constexpr std::uint32_t kProxySteps = 24;
/// Below this share of the tool's radius a motion isn't worth a step, and the proxy is at rest: 0.1
/// uN at 500 N/m and 2 mm.
inline constexpr double kLeastStep = 1e-7;
/// The same where friction holds, and what may be missing of a slip: any place in the cone is at
/// rest, so there is no better one to be near to. 0.1 mN at 500 N/m and 2 mm.
inline constexpr double kSlipShare = 1e-4;
/// Triangles this near, as a share of the tool's radius, touch it: they push, rub and may hold.
/// Wider than a step, or what is just ahead would shorten it to nothing.
inline constexpr double kTouchShare = 1e-4;
/// Triangles that the proxy moves among, in batches of eight: 226 B a batch on the stack. With more
/// in reach those of the farthest batches are left out, and the proxy goes no farther than they are
/// away: it is `under_way`.
inline constexpr std::uint32_t kMaxNearBatches = 144;
/// Times that a step is solved again with the triangle that it would enter; 2 or 3 are usual. What
/// is still entered after it shortens the step, and the next one begins there. No step is shortened
/// to nothing: what touches is among the planes from the first, and the rest is kTouchShare away.
/// Where friction first touches is found from as many faces in the way, and looks at each; beyond
/// them from planes seen from afar, in a shorter step.
inline constexpr std::uint32_t kStepRounds = 16;
/// How far the proxy may sit inside the tool's radius from the surface, relative to that radius;
/// what is deeper counts as entered.
inline constexpr double kContactTolerance = 1e-6;
/// Planes that one motion is held back by; 5 us in six dimensions with all of them. Of more those
/// that hold a tool back least are left out, or a sphere's later ones, from its force only:
/// FrameFault::tool_crowded.
inline constexpr std::uint32_t kMaxHalfSpaces = 64;
/// Faces that are looked at in double at a stand to find what touches there, and, when
/// Budgets::planes are used up, as many to find how far a step is free; 300 instructions each. With
/// more near a ball feels those that were looked at (FrameFault::tool_crowded), and of a step what
/// single precision proves is left.
inline constexpr std::uint32_t kMaxTouchLooks = 4 * kMaxHalfSpaces;
/// Steps of a search for the nearest motion, in each of which a plane joins those that hold it or
/// leaves them. Awkward planes took 72 in the worst of a million searches; after half of them
/// kSqueezeTolerance is enough. After all of them no motion counts as allowed: the tool is
/// `squeezed`.
inline constexpr std::uint32_t kConstraintRounds = 128;
/// A motion may be this far beyond a plane, relative to the lengths in the question.
inline constexpr double kPlaneTolerance = 1e-12;
/// Planes whose normals are dependent to this sine are taken to be so: what is between two such
/// planes that face each other is a gap, not a wedge with an edge far away.
inline constexpr double kParallelPlanes = 1e-7;
/// Planes squeeze when their gap is too narrow by this share of the lengths; by less they fit.
inline constexpr double kSqueezeTolerance = 1e-6;
/// Faces round a ball that its smooth normals are a mean of, 300 instructions each at a stand. With
/// more within their width that is narrower: beside such faces it is wide still.
inline constexpr std::uint32_t kMaxSmoothFaces = 64;
/// What a tool's smooth normals may be a mean over.
inline constexpr double kSmoothWidthMin_m = 1e-4;
inline constexpr double kSmoothWidthMax_m = 0.1;
/// A tool without a radius is a ball of this many quanta, so that it has an outside.
inline constexpr double kPointSkin = 0.25;
/// Past contact points kept while a tool rests, 88 B each. Six planes suffice to hold a body; the
/// rest are candidates. Beyond it the oldest is forgotten: FrameFault::tool_crowded.
inline constexpr std::uint32_t kMaxHolds = 16;
/// A tool without a radius keeps this share of its core's, so that it can slide.
inline constexpr double kLeastSkin = 0.002;
/// Time in which SafeState fades a force to zero, in seconds.
inline constexpr double kFadeTime_s = 0.05;
/// How fast the force of a proxy that had to wait for data catches up: this share of the device's
/// largest force or torque a second, but no more than so many newtons. At 1 kHz 0.8 % and 0.04 N a
/// frame.
inline constexpr double kCatchUpShare_per_s = 8.0;
inline constexpr double kCatchUp_n_per_s = 40.0;
/// Time in which a force that was off comes back, in seconds: slower than it went, so that a cause
/// that comes and goes leaves little force.
inline constexpr double kRiseTime_s = 0.1;
/// A hand that was too fast gets its force back below this share of the limit.
inline constexpr double kCalmSpeedShare = 0.5;
/// A hand that turns faster than this, in rad/s, gets no torque and no force, and what it says
/// counts for no energy: a wrist makes 30.
inline constexpr double kTurningMax_rad_per_s = 60.0;
/// Most damping while a force fades or comes back, as a share of the device's largest force.
inline constexpr double kDampingForceShare = 0.25;
/// The most that coarser faces may change a force by where the pools have room for finer ones, in
/// newtons: a tenth of what a hand feels of a wall.
inline constexpr double kForceToleranceMax_n = 0.1;
/// The same unless an option says otherwise: no hand feels it.
inline constexpr double kForceToleranceUsual_n = 0.001;
/// How fast a force may change beside what hand and objects make, as a share of the device's
/// largest force in a millisecond, unless an option says otherwise: 0.08 N of 8 N. A strike so
/// rises in 100 ms, about as fast as a hand gives way. No less than the least, or none would come
/// in.
inline constexpr double kSlewShare_per_ms = 0.01;
inline constexpr double kSlewShareMin_per_ms = 1e-4;
/// A force that wants to change faster for longer is told as ForceOff::growth, in seconds.
inline constexpr double kChangeTold_s = 0.02;
/// Share of a device's own damping that may be added by computing it. A sampled damper of b on a
/// device with damping B stays passive while b + k T / 2 < B (Colgate and Schenkel 1997), k being
/// the wall's stiffness and T the period; half leaves the other half to the wall.
inline constexpr double kDampingShare = 0.5;

// --- Stability (docs/stability.md) ---------------------------------------------------------------

/// Share of the predicted limit that a wall's stiffness may reach; no unit. Covers fractions of a
/// period in the delay (8 %) and a device's damping that is known to 10 %.
inline constexpr double kStiffnessMargin = 0.9;
/// Positions that a velocity is found from; 16 at 1 kHz tell 1/16 of a quantum a period. 32 B each.
/// Older ones are forgotten: the velocity is that of the newest.
inline constexpr std::uint32_t kVelocitySamples = 16;
/// Forces kept that may still be under way to the device, 32 B each: enough for a delay of nine
/// periods. With a longer one the oldest kept stands for those before it, so the energy is that of
/// a force newer than the device's: ForceAction::blind.
inline constexpr std::uint32_t kForcesUnderWay = 10;
/// A device that is faster has jumped: its energy is not observed (ForceAction::blind). A hand
/// makes 10 m/s at most.
inline constexpr double kDeviceSpeedMax_m_per_s = 10.0;
/// Damping that makes no more force than this isn't added, in newtons: the rounding of a tool at
/// rest.
inline constexpr double kLeastDamping_n = 1e-3;

// --- Convex tools --------------------------------------------------------------------------------

/// Vertices of a convex hull. Each answer asks for a few farthest points and each looks at all
/// vertices, 2 ns apiece; a rounder tool than 64 vertices make is given by a support function. A
/// hull with more is refused.
inline constexpr std::uint32_t kMaxHullVertices = 64;
/// Farthest points that one distance of a convex body and a triangle asks for. Hulls need 4 as a
/// rule and 15 at most in two million cases; curved bodies that nearly touch end here, with bounds
/// that hold but are farther apart.
inline constexpr std::uint32_t kGjkIterations = 64;
/// Bounds nearer to one another than this share of the distance are near enough.
inline constexpr double kGjkRelativeGap = 1e-12;
/// Faces round a vertex of which a normal is made, 16 B each on the stack. With more the normal is
/// zero, which says that it is not known.
inline constexpr std::uint32_t kMaxIncidentFaces = 64;

// --- Poses of objects and of devices -------------------------------------------------------------

/// What `--place`, a host's pose and the frame of a device may say: each coordinate of the
/// translation, either way, and the scale.
inline constexpr double kPoseReachMax_m = 1e4;
inline constexpr double kPoseScaleMin = 1e-3;
inline constexpr double kPoseScaleMax = 1e3;
/// What a material may say: more is nobody's, and would leave the range of what is computed of it.
inline constexpr double kFrictionMax = 1e3;
inline constexpr double kDampingMax_n_s_per_m = 1e9;
/// Length of a texture's bumps, and their height as a share of it. Steeper ones would make a wall
/// more than 1.2 times as stiff as it is, and could pull: docs/stability.md. Other materials are
/// ChangeRefusal::bad_material.
inline constexpr double kTextureLengthMin_m = 1e-4;
inline constexpr double kTextureLengthMax_m = 1.0;
inline constexpr double kTextureSteepest = 0x1p-5;
/// Time in which a material that changes while it is touched becomes the new one: fifty steps at
/// 1 kHz, so that a wall's force changes by a fiftieth of what the new stiffness makes of it.
inline constexpr double kMaterialGlide_s = 0.05;
/// How far R^T R of a tool's or a device frame's rotation may be from the identity, in each entry;
/// it is made orthonormal. Beyond it a sample is FrameFault::tool_invalid, a device frame refused.
inline constexpr double kRotationTolerance = 1e-6;
/// How far the length of a host's quaternion may be from 1. Wider than kRotationTolerance, as
/// senders may compute in float; its length is divided out.
inline constexpr double kPoseUnitTolerance = 1e-3;

// --- Samples of the device -----------------------------------------------------------------------

/// Positions of a device and goals are taken below this coordinate. Wider than kPoseReachMax_m, as
/// a device frame scales and moves what the device says; beyond any device and any model. Others
/// are FrameFault::tool_invalid.
inline constexpr double kGoalRange_m = 1e6;
/// How long the last sample stands in for those that don't come or can't be used. 20 periods of a
/// loop at 1 kHz; after it the force fades within kFadeTime_s (FrameFault::tool_stuck, where it is
/// the device's time that stands still).
inline constexpr double kSampleHold_s = 0.02;
/// A goal that is this many times faster than ToolSpec::speed_max_m_per_s, taken for at least
/// 1 m/s, has jumped (FrameFault::tool_jumped): a hand makes 10 m/s at most.
inline constexpr double kJumpSpeeds = 100.0;
/// Likewise a goal that turns faster than this, in rad/s: at 1 kHz it is 57 degrees in one frame.
inline constexpr double kJumpTurning_rad_per_s = 1'000.0;

// --- Names ---------------------------------------------------------------------------------------

/// A model's or tool's name: at most this many bytes of UTF-8. A longer one is refused.
inline constexpr std::size_t kMaxNameBytes = 63;

} // namespace tactus
