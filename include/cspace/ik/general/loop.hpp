// Six joints as a closed loop. With a frame on each axis, its z along the axis, the arm and its goal close
// up:
//   Rz(a0) M0 Rz(a1) M1 Rz(a2) M2 Rz(a3) M3 Rz(a4) M4 Rz(a5) M5 = I,
// a prismatic joint with Tz in the place of Rz.
// Any joint may come first, and the loop may be read backwards: twelve formulations of one problem.
#pragma once

#include "cspace/ik/dh_form.hpp"
#include "cspace/ik/general/decoupled.hpp"
#include "cspace/ik/solution.hpp"

namespace cspace::ik {

// The frames on the axes of a six-joint arm at zero.
struct LoopFrames {
    Posed between[5];   // from the frame on axis i to that on axis i + 1
    Posed first, last;  // from the base to axis 1, from axis 6 to the tip
};

struct Formulation {
    int shift;       // the loop starts `shift` joints behind the first
    bool backwards;  // and is read from the tip to the base
};
inline constexpr int formulations = 12;

struct Loop {
    Posed M[6];
    bool slides[6];  // Tz(a) in the place of Rz(a)
    int joint[6];    // the joint behind each angle: q = sign · a
    double sign;
};

// Built once per arm: its frames, and the formulations in the order in which they are asked. All lengths are
// over the arm's, those of goals and slides too.
struct GeneralPlan {
    Chain chain;
    double length = 1;  // of the arm [m]
    int slides = 0;     // how many joints slide
    LoopFrames frames;
    int order[formulations];
    int regular = 0;  // how many of them do not vanish identically; 1 where no angle is hidden
    // By how much each enlarges relative errors of its equations, by its number.
    double sensitivity[formulations] = {};
    // Whether by the arm's nature solutions share the hidden angle.
    bool paired[formulations] = {};
    // Hidden angles where each has roots whatever the goal, and the arm nothing: how many, and which.
    static constexpr int most_spurious = 4;
    int spurious_roots[formulations] = {};
    double spurious[formulations * most_spurious] = {};
};

// The plan of an arm, and where it does not suffice alone those of two neighbours (perturbed_arms.hpp).
struct GeneralArm {
    Chain chain;       // the arm as given, of up to six joints
    GeneralPlan plan;  // virtual joints behind its own complete it to six (virtual_joints.hpp)
    PositionFirst position_first;
    GeneralPlan perturbed[2];
    bool alone = false;  // without neighbours, asked for by who has another way
    bool has_perturbed = false;
    // Every solution of a goal, by the code of the instruction set that the plan was made with.
    void (*solve)(const GeneralArm& arm, const Posed& goal, Solutions& out) = nullptr;
    // The same without effort for a certificate, for goals near one that is searched.
    void (*propose)(const GeneralArm& arm, const Posed& goal, Solutions& out) = nullptr;
};

}  // namespace cspace::ik

namespace cspace::ik::inline CSPACE_ISA {

// Each frame stands where its axis comes closest to the frame before: feet of common normals would run away
// from axes that are almost parallel. A slide has a direction and no place: its frame stays where it is.
inline LoopFrames loop_frames(const Chain& chain) {
    LoopFrames out;
    Posed frame[6];
    Vec3d before = chain.point[1];
    for (int i = 0; i < 6; ++i) {
        const Vec3d& z = chain.axis[i];
        if (!chain.prismatic[i]) before = chain.point[i] + dot(before - chain.point[i], z) * z;
        frame[i] = {frame_along(z), before};
    }
    for (int i = 0; i < 5; ++i) out.between[i] = inverse(frame[i]) * frame[i + 1];
    out.first = frame[0];
    out.last = inverse(frame[5]) * chain.tip;
    return out;
}

// The arm with lengths in units of `length`.
inline Chain in_units_of(double length, Chain chain) {
    for (int i = 0; i < chain.n; ++i) chain.point[i] = (1 / length) * chain.point[i];
    chain.tip.t = (1 / length) * chain.tip.t;
    return chain;
}

inline Formulation formulation_of(int number) { return {number % 6, number >= 6}; }
inline int hidden_joint(Formulation form) { return form.backwards ? 5 - form.shift : form.shift; }

// From axis 6 by the goal back to axis 1.
inline Posed closing_link(const LoopFrames& frames, const Posed& goal) {
    return frames.last * (inverse(goal) * frames.first);
}

inline Loop make_loop(const LoopFrames& frames, const bool* prismatic, const Posed& goal, Formulation form) {
    Posed link[6];
    for (int i = 0; i < 5; ++i) link[i] = frames.between[i];
    link[5] = closing_link(frames, goal);
    Loop loop;
    loop.sign = form.backwards ? -1 : 1;
    for (int j = 0; j < 6; ++j) {
        const int k = (form.shift + j) % 6;
        loop.M[j] = !form.backwards ? link[k] : inverse(link[k == 5 ? 5 : 4 - k]);
        loop.joint[j] = form.backwards ? 5 - k : k;  // the first is the hidden joint
        loop.slides[j] = prismatic[loop.joint[j]];
    }
    return loop;
}

}  // namespace cspace::ik::inline CSPACE_ISA
