// Exact tests of the solids that spheres cover, lane by lane, where their covers may touch something.
#pragma once

#include "cspace/collision/placement.hpp"
#include "cspace/collision/scene.hpp"

namespace cspace::collision::inline CSPACE_ISA {

// What a sphere covers against a primitive.
struct PrimitiveTest {
    const Scene& scene;
    const Frame& frame;  // of the body that carries it
    int sphere, primitive;
    bool touches(int lane) const {
        float at[12];
        copy_lane(frame, lane, at);
        return scene.exact.reaches_primitive(scene.exact.owner, sphere, at, primitive, scene.margin);
    }
    // How far they are apart, and the direction.
    float measure(int lane, float* normal) const {
        float at[12];
        copy_lane(frame, lane, at);
        return scene.exact.measure_primitive(scene.exact.owner, sphere, at, primitive, normal) - scene.margin;
    }
};

// Two spheres, or what they cover, against each other.
struct PairTest {
    const Scene& scene;
    const Frame &frame, &other_frame;
    int sphere, other;
    bool touches(int lane) const {
        float at[12], other_at[12];
        copy_lane(frame, lane, at), copy_lane(other_frame, lane, other_at);
        return scene.exact.reaches_sphere(scene.exact.owner, sphere, at, other, other_at, scene.pair_margin);
    }
    float measure(int lane, float* normal) const {
        float at[12], other_at[12];
        copy_lane(frame, lane, at), copy_lane(other_frame, lane, other_at);
        return scene.exact.measure_sphere(scene.exact.owner, sphere, at, other, other_at, normal) -
               scene.pair_margin;
    }
};

// The lanes in which two things touch, or may on their way.
struct RefinedLanes {
    unsigned touching, near;
};

// The last answer is kept: the spheres of a solid come one after the other, and ask the same.
class LastRefined {
  public:
    // A block, a kind of motion, and the numbers of two things.
    struct Question {
        unsigned stamp;
        int kind, one, other;
        friend bool operator==(const Question&, const Question&) = default;
    };
    // way: null if nothing moves; radius: of the ball around the first one.
    template <class Test, class AnyWay>
    RefinedLanes refine(const Question& question, unsigned suspects, const Test& test, const AnyWay* way,
                        float radius) {
        if (question != question_) question_ = question, tested_ = 0, found_ = {0, 0};
        for (unsigned bits = suspects & ~tested_; bits; bits &= bits - 1) {
            const int lane = lowest_lane(bits);
            tested_ |= 1u << lane;
            float normal[3];
            if (test.touches(lane))
                found_.touching |= 1u << lane;
            else if (way && way->may_close(lane, test.measure(lane, normal), radius, normal))
                found_.near |= 1u << lane;
        }
        return {found_.touching & suspects, found_.near & suspects};
    }

  private:
    Question question_ = {0, 0, -1, -1};
    unsigned tested_ = 0;
    RefinedLanes found_ = {0, 0};
};

}  // namespace cspace::collision::inline CSPACE_ISA
