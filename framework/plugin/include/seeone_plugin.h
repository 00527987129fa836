/* The C ABI of seeone's plugins. Generated from framework/plugin/src/abi; to write it
   anew: SEEONE_WRITE_HEADER=1 cargo test --release -p seeone-plugin --test c_header

   What can be asked: the messages of each kind of plugin and of what is lent to it.

   A message is a row of 8-byte cells. A number, a truth (0 or 1) and a count are one cell
   each; real numbers are IEEE doubles. A text is its count of bytes and the bytes, filled up
   with zeros to whole cells; features and depths are a count and single-precision numbers, two
   a cell, filled up likewise. A list is its count and its elements. What may be missing is a
   truth and, where it is there, the thing. A point is x, y, z; a pose is x, y, z and the
   quaternion x, y, z, w; a similarity is a pose and a scale. */

#ifndef SEEONE_PLUGIN_H
#define SEEONE_PLUGIN_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

/**
 * First eight bytes of every table: `SEEONE` and two zeros on a little-endian machine.
 */
#define SEEONE_MAGIC 76202639705427

/**
 * Must be equal on both sides: layouts, messages or meanings changed.
 */
#define SEEONE_ABI_MAJOR 3

/**
 * May differ: functions were appended to the end of a table, whose `size` tells, or methods and
 * codes to those that there were.
 */
#define SEEONE_ABI_MINOR 0

/**
 * `alignment`.
 */
#define SEEONE_KIND_ALIGNMENT 1

/**
 * `camera`.
 */
#define SEEONE_KIND_CAMERA 2

/**
 * `perception`.
 */
#define SEEONE_KIND_PERCEPTION 3

/**
 * `encoding`.
 */
#define SEEONE_KIND_ENCODING 4

/**
 * `transfer`.
 */
#define SEEONE_KIND_TRANSFER 5

/**
 * `kinematics`.
 */
#define SEEONE_KIND_KINEMATICS 6

/**
 * `motion`.
 */
#define SEEONE_KIND_MOTION 7

/**
 * `robot`.
 */
#define SEEONE_KIND_ROBOT 8

/**
 * The questions, each with its request `->` its answer.
 */
enum SeeoneMethod
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint64_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  /**
   * Camera: nothing `->` depth image or none (width, height, fx, fy, cx, cy, depths), list
   * of points, the camera's position.
   */
  SeeoneMethod_Observe = 1,
  /**
   * Perception: an observation as above `->` a canonical cloud: points, canonical points,
   * confidences (three each), features, features a point.
   */
  SeeoneMethod_Perceive = 2,
  /**
   * Encoding: a canonical cloud `->` the number of a new field.
   */
  SeeoneMethod_Encode = 3,
  /**
   * Encoding, or a field that is lent (number 0): a field's number, list of points `->`
   * features a point, features.
   */
  SeeoneMethod_Features = 4,
  /**
   * As above: a field's number, list of points `->` list of winding numbers, or none.
   */
  SeeoneMethod_Winding = 5,
  /**
   * Encoding: a field's number, which is not used again `->` nothing.
   */
  SeeoneMethod_Forget = 6,
  /**
   * Alignment: list of points, list of points, list of weights, a fixed scale or none `->`
   * similarity, residual, share of inliers, condition.
   */
  SeeoneMethod_Align = 7,
  /**
   * Transfer, lent the fields of demonstration and instance: demonstrated pose, its scale,
   * canonical cloud, the instance's scale, gripper points `->` list of candidates: pose,
   * loss, confidence, whether to lay on the surface, origin (text).
   */
  SeeoneMethod_Transfer = 8,
  /**
   * Kinematics, lent a clearance where there is one: the robot or none (the one of the
   * setup), target pose, joints to start near, whether continuous, period or none `->`
   * whether solved, joints, position error, rotation error, steps, contact or none (two
   * names, distance, wanted distance), reason or none.
   */
  SeeoneMethod_Solve = 9,
  /**
   * Motion, lent kinematics: the robot or none (the one of the setup), start joints,
   * whether holding, points of what is carried, key poses, obstacles `->` 1, program, cost; or
   * 0, stage, reason.
   */
  SeeoneMethod_Plan = 10,
  /**
   * Robot: nothing `->` joints, opening.
   */
  SeeoneMethod_State = 11,
  /**
   * Robot, lent a watcher: an action `->` opening, whether holding, whether contact.
   */
  SeeoneMethod_Execute = 12,
  /**
   * A clearance that is lent: joints `->` contact or none.
   */
  SeeoneMethod_Contact = 13,
  /**
   * A clearance that is lent: joints, distance `->` list of proximities: margin, normal
   * (point), two carriers or none each (link, point).
   */
  SeeoneMethod_Proximities = 14,
  /**
   * A watcher that is lent: seconds, joints, opening `->` nothing. Any code but `OK` asks the
   * robot to stop and to end the action with that code.
   */
  SeeoneMethod_Watch = 15,
  /**
   * The world: nothing `->` seconds, seconds a frame, opening, whether the fingers move,
   * whether the pads feel a load, the load (point).
   */
  SeeoneMethod_WorldState = 16,
  /**
   * The world: pose of the hand, at once `->` nothing.
   */
  SeeoneMethod_PlaceHand = 17,
  /**
   * The world: pose of the hand at the end of one frame `->` nothing.
   */
  SeeoneMethod_Advance = 18,
  /**
   * The world: force `->` nothing.
   */
  SeeoneMethod_CloseFingers = 19,
  /**
   * The world: opening `->` nothing.
   */
  SeeoneMethod_OpenFingers = 20,
  /**
   * The world: nothing `->` list of surfaces: points, list of triangles
   * (three numbers each), whether it has the colour of the objects to be taken.
   */
  SeeoneMethod_Surfaces = 21,
  /**
   * Robot: nothing `->` nothing. It stands still where it is.
   */
  SeeoneMethod_Stop = 22,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum SeeoneMethod SeeoneMethod;
#else
typedef uint64_t SeeoneMethod;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Borrowed elements in a row; `data` may be anything when `len` is zero.
 */
typedef struct SeeoneSpan_u8 {
  /**
   * The first element.
   */
  const uint8_t *data;
  /**
   * Number of elements.
   */
  size_t len;
} SeeoneSpan_u8;

/**
 * The beginning of every table, in every version.
 */
typedef struct SeeoneHeader {
  /**
   * `MAGIC`.
   */
  uint64_t magic;
  /**
   * The ABI's major version that the library was built for.
   */
  uint32_t abi_major;
  /**
   * The ABI's minor version that the library was built for.
   */
  uint32_t abi_minor;
  /**
   * Bytes of the whole table, this header among them.
   */
  uint64_t size;
  /**
   * The plugin's kind, one of `KIND_...`.
   */
  uint32_t kind;
  /**
   * Zero.
   */
  uint32_t reserved;
  /**
   * The plugin's name, UTF-8.
   */
  struct SeeoneSpan_u8 name;
  /**
   * The plugin's version, UTF-8.
   */
  struct SeeoneSpan_u8 version;
  /**
   * What the library was built with, UTF-8; for people.
   */
  struct SeeoneSpan_u8 build_id;
} SeeoneHeader;

/**
 * How a call ended. Any other code than those named here counts as `INTERNAL`.
 */
typedef int32_t SeeoneStatus;
/**
 * It worked.
 */
#define SeeoneStatus_OK 0
/**
 * The plugin's table of the configuration is wrong.
 */
#define SeeoneStatus_CONFIGURATION 1
/**
 * What was handed over cannot be worked on.
 */
#define SeeoneStatus_INPUT 2
/**
 * A file that the plugin needs is missing or damaged.
 */
#define SeeoneStatus_RESOURCE 3
/**
 * A fault inside the plugin, a caught panic among them.
 */
#define SeeoneStatus_INTERNAL 4
/**
 * The caller asked for an end before the work was done, and there was one.
 */
#define SeeoneStatus_CANCELLED 5

/**
 * Borrowed elements in a row; `data` may be anything when `len` is zero.
 */
typedef struct SeeoneSpan_u64 {
  /**
   * The first element.
   */
  const uint64_t *data;
  /**
   * Number of elements.
   */
  size_t len;
} SeeoneSpan_u64;

/**
 * Borrowed elements in a row; `data` may be anything when `len` is zero.
 */
typedef struct SeeoneSpan_Service {
  /**
   * The first element.
   */
  const struct SeeoneService *data;
  /**
   * Number of elements.
   */
  size_t len;
} SeeoneSpan_Service;

/**
 * Where the called side leaves its answer: it calls `give` once, with cells that need to be
 * valid during that call alone.
 */
typedef struct SeeoneAnswer {
  /**
   * Handed to `give` unchanged.
   */
  void *target;
  /**
   * Takes a copy of the answer.
   */
  void (*give)(void *target, struct SeeoneSpan_u64 cells);
} SeeoneAnswer;

/**
 * Where the called side writes why it failed, UTF-8 without a final zero.
 */
typedef struct SeeoneMessage {
  /**
   * The buffer.
   */
  uint8_t *data;
  /**
   * Its size in bytes.
   */
  size_t capacity;
  /**
   * Bytes written, set by the called side.
   */
  size_t length;
} SeeoneMessage;

/**
 * Answers one message: `method` of `methods.rs` with its request. What is lent may be called
 * until this call returns. May be null where nothing answers.
 */
typedef SeeoneStatus (*SeeoneCall)(void *object,
                                   uint64_t method,
                                   struct SeeoneSpan_u64 request,
                                   struct SeeoneSpan_Service lent,
                                   const struct SeeoneAnswer *answer,
                                   struct SeeoneMessage *message);

/**
 * Something that answers messages, lent to the called side. It may be called from any thread.
 */
typedef struct SeeoneService {
  /**
   * Handed to `call` unchanged.
   */
  void *object;
  /**
   * Answers; null when nothing is lent.
   */
  SeeoneCall call;
} SeeoneService;

/**
 * The table of one plugin. No function may unwind; a null one is refused. The calls on
 * one instance, from `create` to `release`, come one after the other; with the host's usual
 * patience, which ends with a plugin that does not return, all from one thread.
 */
typedef struct SeeoneTable {
  /**
   * What every table begins with.
   */
  struct SeeoneHeader header;
  /**
   * Builds a plugin from its setup and leaves it behind `instance`. The world may be called
   * until the plugin is released.
   */
  SeeoneStatus (*create)(struct SeeoneSpan_u64 setup,
                         struct SeeoneService world,
                         void **instance,
                         struct SeeoneMessage *message);
  /**
   * Answers one message; the object is the instance.
   */
  SeeoneCall call;
  /**
   * Ends a plugin; called once, after every other call on it.
   */
  void (*release)(void *instance);
} SeeoneTable;

/**
 * Returns the library's table of this index, from zero, which stays valid and unchanged for
 * good; null beyond the last.
 */
typedef const struct SeeoneHeader *(*SeeoneEntry)(uint32_t index);

/**
 * Every method, in order.
 */
#define SeeoneMethod_ALL { SeeoneMethod_Observe, SeeoneMethod_Perceive, SeeoneMethod_Encode, SeeoneMethod_Features, SeeoneMethod_Winding, SeeoneMethod_Forget, SeeoneMethod_Align, SeeoneMethod_Transfer, SeeoneMethod_Solve, SeeoneMethod_Plan, SeeoneMethod_State, SeeoneMethod_Execute, SeeoneMethod_Contact, SeeoneMethod_Proximities, SeeoneMethod_Watch, SeeoneMethod_WorldState, SeeoneMethod_PlaceHand, SeeoneMethod_Advance, SeeoneMethod_CloseFingers, SeeoneMethod_OpenFingers, SeeoneMethod_Surfaces, SeeoneMethod_Stop, }

#endif  /* SEEONE_PLUGIN_H */

/* The one symbol that a library exports: its table of this index, from zero; NULL
   beyond the last. */
#ifdef __cplusplus
extern "C"
#endif
const struct SeeoneHeader *seeone_plugin(uint32_t index);
