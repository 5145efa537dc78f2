# SPDX-License-Identifier: Apache-2.0
# The layers of the project as data: which module may include which. cmake/checks/guards.py reads
# this file and fails on every #include that breaks it, and on modules that include each other in a
# circle. It knows the three commands below, ${lists} and comments, nothing else of CMake.
#
# A module is a folder (or one file). A file belongs to the module with the longest matching path. A
# module may always include itself; an allowed name also allows the modules below it ("rt_core"
# means every module of rt_core); "*" allows everything. The comment above each says what lives
# there.
#
# tactus_module(<path> <allowed module>...)
# tactus_external(<first part of the include's path> <module>...): a library's headers and the only
# modules (with the modules below them) that may include them.
# set(<list> <word>...)

# --- rt_core: what runs on the haptic thread. Stages are siblings and never include one another;
# they meet in query, refine and frame.
set(stage_layer
    rt_core/base rt_core/math rt_core/limits.hpp rt_core/geometry rt_core/records rt_core/spm)

# The words that all code shares: results, assertions, arenas, queues, fixed vectors, identifiers.
tactus_module(rt_core/base)
# Vectors, boxes, rotations, similarities, and arithmetic whose rounding is known.
tactus_module(rt_core/math rt_core/base rt_core/math/seen_triangle.hpp)
# A record without inline functions: all of math that a kernel set may see.
tactus_module(rt_core/math/seen_triangle.hpp rt_core/base)
# Distances, crossings and supports of points, segments, triangles, boxes and hulls.
tactus_module(rt_core/geometry rt_core/base rt_core/math rt_core/limits.hpp)
# Every limit that more than one module knows, with what happens at it.
tactus_module(rt_core/limits.hpp rt_core/base)
# The model's format: header, index pages, chunks, and the pages and links that they become.
tactus_module(rt_core/spm rt_core/base rt_core/math rt_core/limits.hpp)
# Plain data that stages hand to each other, and what goes into a frame and comes out.
tactus_module(rt_core/records
    rt_core/base rt_core/math rt_core/limits.hpp rt_core/geometry rt_core/spm)
# The stage that knows which chunks are here, wanted or given back.
tactus_module(rt_core/cache ${stage_layer} rt_core/kernels)
# The inner loops of queries, once for each instruction set.
tactus_module(rt_core/kernels rt_core/base rt_core/limits.hpp rt_core/math/seen_triangle.hpp)
# The tree of boxes over the active faces: changes, refits and walks.
tactus_module(rt_core/abtree ${stage_layer} rt_core/kernels)
# The active faces, split and merged. The forest hands each change straight to the tree
# (docs/internals/decisions/0005-the-frame.md).
tactus_module(rt_core/forest ${stage_layer} rt_core/abtree rt_core/kernels)
# The stage that says which regions a tool comes to next.
tactus_module(rt_core/predict ${stage_layer})
# The stage that makes a force from contacts, and makes it safe for a device.
tactus_module(rt_core/force ${stage_layer} rt_core/kernels rt_core/query/probe.hpp)
# The objects' table, where they are, and which are near a tool.
tactus_module(rt_core/scene ${stage_layer})
# Distances and contacts of a tool and the active faces, exactly or as bounds.
tactus_module(rt_core/query ${stage_layer} rt_core/abtree rt_core/kernels rt_core/query/probe.hpp)
# How kernels see a place: what asks a tree and what moves among its faces both do.
tactus_module(rt_core/query/probe.hpp rt_core/kernels rt_core/limits.hpp rt_core/math)
# The stage that splits what a query needs and merges what none needs.
tactus_module(rt_core/refine ${stage_layer}
    rt_core/abtree rt_core/forest rt_core/kernels rt_core/cache rt_core/query)
# The order of the stages, and the pools, models, tools and pairs that they work on.
tactus_module(rt_core/frame rt_core)

# --- transport: chunks wanted, chunks delivered. Parse and link live in spm; of the cache it knows
# inbox and page slots.

# What every module above rt_core may use: refusals, texts and their numbers, files that appear
# whole, the program's log, exit codes. It knows rt_core/base alone.
tactus_module(transport/base rt_core/base)
# The chunk loader between cache and link, and what servers and controllers say of models, objects,
# materials and runs.
tactus_module(transport ${stage_layer} rt_core/cache transport/base)
# What a frame and the chunk loader beside it take together.
tactus_module(transport/pool_plan.hpp rt_core)
# The plan's search; it asks both for their sizes.
tactus_module(transport/pool_plan.cpp rt_core transport)
# A frame that refines all of a model, once.
tactus_module(transport/store/static_model.cpp rt_core transport transport/base)

# --- platform: the machine, the devices, the controller.
set(platform_layer
    transport/base rt_core/base rt_core/math rt_core/geometry rt_core/records rt_core/limits.hpp)

# What the operating system gives: clock, timer, real-time thread, locked memory, counters of work
# and time. It knows nothing of devices and meshes. What only POSIX or Linux has is in posix/.
tactus_module(platform/machine transport/base rt_core/base)
# What a haptic device is, and what stands around any of them: frame, brake, guard.
tactus_module(platform/devices platform/machine ${platform_layer})
# A device that another thread talks to, and what is wrong with what it says of itself; a rule of
# rt_core/force judges that.
tactus_module(platform/devices/remote platform/devices platform/machine ${platform_layer}
    rt_core/force)
# Devices of drivers that send datagrams.
tactus_module(platform/devices/udp platform/devices platform/machine ${platform_layer})
# Devices of Force Dimension, through their library.
tactus_module(platform/devices/dhd platform/devices platform/machine ${platform_layer})
# Devices of shared libraries that users write.
tactus_module(platform/devices/plugin platform/devices platform/machine ${platform_layer})
# Devices, hands, clocks and timers that a program moves alone.
tactus_module(platform/devices/simulated platform/devices platform/machine ${platform_layer})
# The command line of all programs: options, exit codes, main(), progress, signals, standard output.
# It is the only module that includes CLI11 (docs/internals/decisions/0003-command-line-room.md).
tactus_module(platform/program transport/base)
# Recordings of frames and their replay; they know nothing of the machine.
tactus_module(platform/recording transport/base rt_core)
# Recordings for other tools: CSV, JSON lines, MCAP.
tactus_module(platform/export transport/base platform/recording rt_core)
# Pages with charts; they know nothing of what was measured.
tactus_module(platform/plot)
# The haptic loop: tool ports between devices and frame, the supervisor and the brake beside it, the
# mailboxes and taps to other threads, and the accounts of deadlines and safety.
tactus_module(platform/loop platform/machine platform/devices platform/recording transport rt_core)
# What a run is asked for, as plain data, the texts that say it, and the devices and virtual
# fixtures that are made of it.
tactus_module(platform/choices platform/loop platform/machine platform/devices platform/recording
    transport rt_core)
# The objects of a run: a scene of a file or a server, who moves them, and how they feel.
tactus_module(platform/scene platform/choices platform/loop platform/machine platform/devices
    transport rt_core)
# One run: pools, frame, chunk loader, devices, threads, recorder and topics, from the choices to
# what is known at the end. It needs neither a command line nor a report.
tactus_module(platform/controller platform/scene platform/choices platform/loop platform/machine
    platform/devices platform/recording transport rt_core)
# The command line of hrtc: its options, the checks of each, and what a signal or a terminal has to
# do with a run.
tactus_module(platform/options platform/controller platform/scene platform/choices platform/loop
    platform/machine platform/devices platform/recording platform/export platform/program transport
    rt_core)
# What is said of a run: first lines, report, summary, page, histograms, verdict.
tactus_module(platform/report platform/controller platform/scene platform/choices platform/loop
    platform/machine platform/devices platform/recording platform/plot transport rt_core)
# The commands that look at the machine: deadline-test with its self-check and its load, and the
# doctor's command.
tactus_module(platform/diagnose platform/diagnose/doctor platform/report platform/options
    platform/controller platform/scene platform/choices platform/loop platform/machine
    platform/devices platform/recording platform/plot platform/program transport rt_core)
# What the machine is like, as far as it matters for the loop; of frames and models it knows
# nothing.
tactus_module(platform/diagnose/doctor platform/machine transport/base)
# The readers of meshes and scenes of host_tools, which programs lend to the rest of platform.
tactus_module(platform/readers platform/scene platform/choices platform/loop platform/machine
    platform/devices transport rt_core host_tools/mesh host_tools/scene)
# The public class World: objects, hands and their loop for programs of others. It encodes meshes
# and edits models, too.
tactus_module(platform/world platform/readers platform/controller platform/scene platform/choices
    platform/loop platform/machine platform/devices platform/recording transport rt_core
    host_tools/mesh host_tools/build host_tools/edit)
# The program hrtc: main(), its commands, the replay of a recording.
tactus_module(platform/hrtc rt_core transport platform)

# --- host_tools: the graphics station's libraries and programs. No module includes a program.
set(host_layer transport/base rt_core transport)

# Triangle meshes, read, cleaned and written.
tactus_module(host_tools/mesh ${host_layer})
# Scenes: glTF 2.0 files, read and written; their meshes are read when they are asked for.
tactus_module(host_tools/scene ${host_layer} host_tools/mesh)
# Meshes that are made by a rule.
tactus_module(host_tools/shapes ${host_layer} host_tools/mesh)
# The collapse of a mesh to a base, each step with its proven error.
tactus_module(host_tools/simplify ${host_layer} host_tools/mesh)
# Models written and taken apart: records, pieces, regions, cut-outs.
tactus_module(host_tools/encode ${host_layer} host_tools/mesh host_tools/simplify)
# A mesh in memory as a model's file, as spm_build and a World make it.
tactus_module(host_tools/build ${host_layer} host_tools/mesh host_tools/simplify host_tools/encode)
# A model's surface while it is edited: cut, filled and moved, and saved.
tactus_module(host_tools/edit ${host_layer} host_tools/mesh host_tools/encode host_tools/build)
# Local servers of HTTP: metrics, and the streams of a viewer.
tactus_module(host_tools/web ${host_layer})
# The library for C and what calls C.
tactus_module(host_tools/c ${host_layer} platform/world)
# The library for Python, on that for C.
tactus_module(host_tools/python host_tools/c)
# The program that makes models of meshes and scenes.
tactus_module(host_tools/spm_build ${host_layer} platform/program host_tools/mesh host_tools/scene
    host_tools/shapes host_tools/simplify host_tools/encode host_tools/build)
# The program that looks into a model.
tactus_module(host_tools/spm_inspect ${host_layer} platform/program host_tools/mesh
    host_tools/encode)
# The program that serves models and scenes.
tactus_module(host_tools/spm_publish ${host_layer} platform/program host_tools/mesh
    host_tools/scene host_tools/web host_tools/encode host_tools/edit host_tools/build)
# The program that runs the others under one name.
tactus_module(host_tools/tactus ${host_layer} platform/program)
# The program that makes the keys of a site.
tactus_module(host_tools/keys ${host_layer} platform/program)
# The program that shows a run in a browser; it plays recordings, too.
tactus_module(host_tools/spm_view ${host_layer} platform/program host_tools/mesh host_tools/encode
    host_tools/web platform/recording platform/devices platform/machine)

# Tests may include everything.
tactus_module(tests *)

# --- Libraries of others.
tactus_external(dds transport/dds tests)
# Certificates and signatures of DDS Security.
tactus_external(openssl transport/dds host_tools/keys tests)
tactus_external(ccd rt_core/query tests)
tactus_external(Eigen rt_core platform transport host_tools tests)
tactus_external(CLI platform/program)
tactus_external(nlohmann platform/diagnose platform/hrtc platform/plot platform/report host_tools
    tests)
tactus_external(fmt platform/choices platform/controller platform/diagnose platform/export
    platform/hrtc platform/options platform/plot platform/program platform/report platform/scene
    platform/world transport host_tools tests)
tactus_external(assimp host_tools/mesh tests)
tactus_external(tbb host_tools tests)
# The only modules that speak HTTP.
tactus_external(httplib.h host_tools/spm_view host_tools/web tests)
tactus_external(oneapi host_tools tests)
tactus_external(pybind11 host_tools/python)
tactus_external(gtest tests)
tactus_external(rapidcheck tests)
# libsodium's one header; rt_core must not hash with it, since it may allocate.
tactus_external(sodium.h transport host_tools platform/options tests)

# --- Standard headers of rt_core: nothing that brings a heap, a clock, a thread, a file or a throw.
set(TACTUS_RT_CORE_STANDARD_HEADERS
    algorithm array atomic bit climits cmath compare concepts cstddef cstdint cstring
    initializer_list iterator limits new numbers numeric optional span string_view tuple
    type_traits utility variant immintrin.h)
