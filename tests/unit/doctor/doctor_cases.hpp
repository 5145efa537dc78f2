// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// Results of each check on a good machine with the changes of a case:
///
/// check => changes => verdict => found => remedies => result
///
/// An indented line continues the one before; lists are separated by ";;", the values of a change
/// by '%', one case for each. A change is a file's path=content, folder/, -path to remove it,
/// ~interface=flags state, or a measurement. In a text, "..." at the end stands for anything, "*"
/// is any text, and a last remedy "..." any others; "!" is run. "good" as the result: the check is
/// good then.
namespace tactus::doctor
{

inline constexpr const char* kDoctorCases = R"(
clock-source => @clock/current_clocksource=xen => good => 'xen', 0 system calls in 64 reads
clock-source => @clock/current_clocksource=xen ;; calls=64
    => critical => 'xen', 64 system calls in 64 reads
clock-source => calls=none ;; @clock/current_clocksource=
    tsc%kvm-clock%arch_sys_counter%hyperv_clocksource_tsc_page => good
clock-source => calls=none ;; @clock/current_clocksource=hpet%acpi_pm%jiffies%refined-jiffies
    => critical
clock-source => calls=none ;; @clock/current_clocksource=xen%%tsc hpet%sundial => unknown
clock-source => -@clock/current_clocksource => good
clock-source => -@clock/current_clocksource ;; calls=none => unknown
clock-source => calls=none ;; @clock/current_clocksource=hpet\n
    ;; @clock/available_clocksource=hpet kvm-clock tsc acpi_pm \n
    => critical => => !* ;; ... => @clock/current_clocksource=tsc\n ;; good
clock-source => calls=64 => critical => => ...clocksource=tsc tsc=reliable... ;; ...
clock-source => calls=64 ;; machine=aarch64 => critical => => dmesg... ;; ...

timer => resolution=1000 => good
timer => resolution=1001 => critical
timer => resolution=4000000 => critical => => grep HIGH_RES_TIMERS... ;; ...
timer => resolution=none%0%-1 => unknown
timer => resolution=4000000 ;; /proc/cmdline=quiet highres=off\n
    ;; /etc/default/grub=GRUB_CMDLINE_LINUX="highres=off quiet"\n
    => critical => => !* ;; ... => /etc/default/grub=GRUB_CMDLINE_LINUX=" quiet"\n

float-control => float=changed => critical => => ...ldmxcsr... ;; ...
float-control => float=changed ;; preloaded=fast.so
    => critical => ...LD_PRELOAD is 'fast.so' => unset LD_PRELOAD

preemption => -/sys/kernel/realtime => good
preemption => /proc/version=Linux version 5.10 #1 SMP PREEMPT => good
preemption => -/sys/kernel/realtime
    ;; /proc/version=Linux version 6.1 #1 SMP PREEMPT_DYNAMIC Debian
    ;; /sys/kernel/debug/sched/preempt=none (voluntary) full\n
    => advice => the kernel has PREEMPT_DYNAMIC, not PREEMPT_RT, and runs as 'voluntary'
    => sudo apt-get install linux-image-rt-amd64 && sudo reboot ;; !*
    => /sys/kernel/debug/sched/preempt=full\n
preemption => -/sys/kernel/realtime ;; /proc/version=Linux version 6.1 #1 SMP PREEMPT Debian
    ;; /sys/kernel/debug/sched/preempt=none voluntary (full)\n ;; machine=aarch64
    => advice => the kernel has PREEMPT, not PREEMPT_RT, and runs as 'full'
    => sudo apt-get install linux-image-rt-arm64 && sudo reboot
preemption => -/sys/kernel/realtime ;; -/proc/version => good
preemption => -/sys/kernel/realtime ;; -/proc/version ;; version=#1 SMP
    => advice => the kernel has no kind of PREEMPT, not PREEMPT_RT
preemption => -/sys/kernel/realtime ;; -/proc/version ;; version= => unknown

rt-throttling => @kernel/sched_rt_runtime_us=-1%1000000%2000000 => good
rt-throttling => @kernel/sched_rt_runtime_us=999999%950000%1 => advice
rt-throttling => @kernel/sched_rt_runtime_us=0 => critical
rt-throttling => @kernel/sched_rt_runtime_us=-2%%many => unknown
rt-throttling => @kernel/sched_rt_runtime_us=950000 ;; @kernel/sched_rt_period_us=0%-5%x%
    => unknown => ...sched_rt_period_us...

compaction => => good => the kernel does not move locked memory
compaction => /proc/sys/vm/compact_unevictable_allowed=1\n%2 => advice
compaction => /proc/sys/vm/compact_unevictable_allowed=%no => unknown

isolation => => good => processor 3 is isolated, without a tick
isolation => @cpu/nohz_full=(null)\n => good => processor 3 is isolated, with a tick
isolation => cpu=2 => advice
isolation => cpu=none => advice => => hrtc doctor --cpu 3 # And hrtc --cpu 3.
isolation => @cpu/isolated=\n
    ;; /etc/default/grub=GRUB_TIMEOUT=5\nGRUB_CMDLINE_LINUX="quiet"\n
    => advice => => !... && sudo update-grub && sudo reboot
    => /etc/default/grub=GRUB_TIMEOUT=5\nGRUB_CMDLINE_LINUX="isolcpus=managed_irq,domain,3
    \x20nohz_full=3 rcu_nocbs=3 irqaffinity=0-2 quiet"\n
isolation => @cpu/isolated= ;; @cpu/online=0 ;; cpu=0
    => advice => => ...needs another... ;; ...

interrupts => => good => 0 of 1 interrupts go to processor 3; new ones do not
interrupts => @irq/24/effective_affinity_list=3\n
    => advice => 1 of 1 interrupts go to processor 3 (24 'eth0'); new ones do not
interrupts => @irq/9/smp_affinity_list=0-3\n => good
interrupts => -@irq/24/effective_affinity_list ;; @irq/24/smp_affinity_list=0-3\n ;; @irq/24/disk/
    ;; @irq/25/smp_affinity_list=0-3\n ;; @irq/25/disk/ ;; @irq/26/smp_affinity_list=0-3\n
    ;; @irq/26/disk/ ;; @irq/27/smp_affinity_list=0-3\n ;; @irq/27/disk/
    ;; @irq/default_smp_affinity=f\n ;; /usr/sbin/irqbalance= => advice
    => 4 of 4 interrupts go to processor 3 (24 'disk', 25 'disk', 26 'disk', ...); new ones may
    => sudo systemctl disable --now irqbalance ;; !* ;; !* => good
interrupts => @irq/24/effective_affinity_list=? ;; @irq/24/smp_affinity_list=
    => unknown => ...; 1 with an unknown target
interrupts => @irq/24/effective_affinity_list=? ;; @irq/24/smp_affinity_list=
    ;; @irq/default_smp_affinity=f\n => advice
interrupts => cpu=none => advice => => hrtc doctor --cpu 3
interrupts => cpu=0 ;; @cpu/online=0 ;; @irq/default_smp_affinity=1
    => advice => => lscpu --online --extended # One processor is too few.

governor => @cpu/cpu0/cpufreq/scaling_governor=powersave\n => good
governor => @cpu/cpu0/cpufreq/scaling_governor=powersave\n ;; cpu=none
    => advice => processors 1-3: performance; processor 0: powersave
governor => @cpu/cpu1/cpufreq/scaling_governor=schedutil\n
    ;; @cpu/cpu3/cpufreq/scaling_governor=ondemand\n
    => advice => => !* ;; ... => @cpu/cpu1/cpufreq/scaling_governor=schedutil\n ;; good
governor => @cpu/cpu1/cpufreq/scaling_governor=schedutil\n
    ;; @cpu/cpu3/cpufreq/scaling_governor=ondemand\n ;; cpu=none
    => advice => => !* ;; ... => @cpu/cpu1/cpufreq/scaling_governor=performance\n ;; good
governor => -@cpu/cpu0/cpufreq ;; -@cpu/cpu1/cpufreq ;; -@cpu/cpu2/cpufreq ;; -@cpu/cpu3/cpufreq
    ;; cpu=none => good
    => processors 0-3 without a governor: the clock rate is fixed or set by the hypervisor
governor => @cpu/cpu3/cpufreq/scaling_governor=
    %PERFORMANCE%performance now%\x1b[2J%averyveryverylongname => unknown

idle-states => @idle/state2/latency=50\n ;; @idle/state2/disable=0\n ;; @idle/state3/latency=890\n
    ;; @idle/state3/disable=1\n => good => driver 'intel_idle', up to 50 us to wake
idle-states => @idle/state2/latency=51\n ;; @idle/state2/disable=0\n => advice
idle-states => @cpu/cpu2/cpuidle/state2/latency=200\n => good
idle-states => @cpu/cpu2/cpuidle/state2/latency=200\n ;; @cpu/cpu2/cpuidle/state2/disable=0\n
    ;; @cpu/cpu2/cpuidle/state3/latency=200\n ;; @cpu/cpu2/cpuidle/state3/disable=0\n ;; cpu=none
    => advice => => !* ;; ... => @cpu/cpu2/cpuidle/state1/disable=0\n ;; good
idle-states => @idle/state2/latency=890\n ;; /dev/cpu_dma_latency=\x0a\0\0\0 => good
    => driver 'intel_idle', up to 890 us to wake, limited to 10 us by /dev/cpu_dma_latency
idle-states => @idle/state2/latency=890\n
    ;; /dev/cpu_dma_latency=%0%\xff\xff\xff\xff%\0\0\0\0\0\0\0\0\0 => advice
idle-states => @idle/state1/latency=%-1%deep%1 2
    => unknown => ...cpu3/cpuidle/state1/latency...

smt => @cpu/cpu3/topology/thread_siblings_list=1,3\n
    => advice => processor 3 shares its core with 1
    => echo 0 | sudo tee /sys/devices/system/cpu/cpu1/online
smt => @cpu/cpu3/topology/thread_siblings_list=%1%3-1%x => unknown
smt => cpu=none => good
smt => cpu=none ;; @cpu/smt/active=1\n
    => advice => => echo off | sudo tee /sys/devices/system/cpu/smt/control
smt => cpu=none ;; @cpu/smt/active=2\n => unknown

priority => rtprio=0 ;; /proc/self/status=CapEff:\t0000000000800000\n
    => good => SCHED_FIFO 81 granted; rtprio limit 0, CAP_SYS_NICE held
priority => fifo=EPERM ;; rtprio=80 ;; @limits=
    => critical => SCHED_FIFO 81 refused (EPERM); rtprio limit 80, CAP_SYS_NICE not held
    => !* ;; * => @limits=hand - rtprio 99\n
priority => fifo=EPERM ;; rtprio=81 ;; /proc/self/status=CapEff:\t0\n
    => critical => ...the control group has no share of real time
    => echo 950000 | sudo tee '/sys/fs/cgroup/cpu/user.slice/cpu.rt_runtime_us'
priority => fifo=EPERM ;; rtprio=0 ;; /proc/self/status=CapEff:\t0000000000800000\n
    => critical => ...the control group has no share of real time
    => echo 950000 | sudo tee '/sys/fs/cgroup/cpu/user.slice/cpu.rt_runtime_us'
priority => fifo=EPERM ;; /proc/self/cgroup=0::/user.slice\nnonsense\n:\n
    => critical => => echo $$ | sudo tee /sys/fs/cgroup/cgroup.procs... ;; ...
priority => /proc/self/status=%CapEff:\t\n%CapEff:\txyz\n%CapPrm:\t00ff\n
    => good => ...CAP_SYS_NICE not known to be held

memlock => => good
    => locking all memory granted; memlock limit unlimited, CAP_IPC_LOCK not held
memlock => lock=refused ;; memlock=65536 ;; user=:1000 ;; @limits=hand - rtprio 99\n => critical
    => locking all memory refused; memlock limit 65536 bytes, CAP_IPC_LOCK not held
    => !* ;; ... => @limits=hand - rtprio 99\n:1000 - memlock unlimited\n
memlock => lock=refused ;; memlock=none => critical => ...limit unknown,...

huge-pages => @huge=always madvise [never]%always [madvise] never => good
huge-pages => @huge=[always] madvise never => advice => => !* ;; ... => @huge=madvise\n
huge-pages => @huge=always madvise never%%[sometimes] => unknown
huge-pages => -/sys/kernel/mm/transparent_hugepage => good
huge-pages => -/sys/kernel/mm => unknown

dds-configuration => => good => CYCLONEDDS_URI is not set
dds-configuration => /etc/dds.xml=<NetworkInterface name="eth0"/> ;; uri=file:///etc/dds.xml
    => good => CYCLONEDDS_URI is 'file:///etc/dds.xml'
dds-configuration => uri=file:///etc/dds.xml
    => critical => ...; '/etc/dds.xml' can't be read => unset CYCLONEDDS_URI... ;; ...

dds-interface => ~eth0=0x1002 down => good => 'lo' is up
dds-interface => ~lo=0x8 down => critical => 'lo' is down => sudo ip link set dev 'lo' up
dds-interface => uri=<CycloneDDS><Domain><General><Interfaces><NetworkInterface name="eth0"/>
    => good
dds-interface => uri=<NetworkInterface name="eth0"/> ;; ~eth0=0x1003 down
    => critical => 'eth0' is up without a link
    => ip link show dev 'eth0' # If NO-CARRIER is shown, check the cable.
dds-interface => uri=<NetworkInterface name="eth0"/> ;; ~eth0=0x1002 down%0x1002 unknown
    => critical => 'eth0' is down
dds-interface => uri=<NetworkInterface name="eth0"/> ;; ~eth0=many up
    => unknown => 'eth0' has an unknown state
dds-interface => uri=<NetworkInterface name="eth0"/> ;; -@net/eth0
    => critical => 'eth0' does not exist
dds-interface => ~eth0= up ;; uri=<NetworkInterface name='lo'/><NetworkInterface name='eth1'/>
    <NetworkInterface name='eth0'/>
    => critical => 'lo' is up; 'eth1' does not exist; 'eth0' has an unknown state => * ;; *
dds-interface => uri=<CycloneDDS/> => good => no interface is named; 'eth0' is up
dds-interface => uri=<CycloneDDS/> ;; ~eth0=0x1002 down
    => advice => => sudo ip link set dev 'eth0' up
dds-interface => uri=<CycloneDDS/> ;; ~eth0=0x1002 down ;; ~lo=0x8 down
    => critical => no interface is up
dds-interface => uri=<CycloneDDS/> ;; ~lo=0x8 down ;; -@net/eth0
    => critical => => ip -brief link # There is only the loopback. ;; ...
dds-interface => uri=<NetworkInterface name="a'; reboot"/> ;; ~a'; reboot=0x1002 down
    => critical => => sudo ip link set dev 'a'\\''; reboot' up

dds-buffers => => good
dds-buffers => @core/rmem_max=1048575\n ;; @core/wmem_max=65536\n
    ;; /etc/sysctl.d/60-tactus.conf= => advice => => * ;; sudo sysctl --system
dds-buffers => @core/rmem_max=1048575\n ;; @core/wmem_max=65535\n
    ;; /etc/sysctl.d/60-tactus.conf= => advice => => !* ;; !* ;; *
    => /etc/sysctl.d/60-tactus.conf=net.core.rmem_max=1048576\nnet.core.wmem_max=65536\n
dds-buffers => @core/wmem_max=-1\n => unknown
)";

} // namespace tactus::doctor
