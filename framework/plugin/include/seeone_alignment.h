/* What every alignment in C needs, around the one function that it is about:

       static SeeoneStatus align(const SeeonePairs *pairs, SeeoneFound *found, SeeoneMessage *message);
       SEEONE_ALIGNMENT("my-name", "1", align)

   The pairs have been checked: as many points, targets and weights, all finite, no weight below
   zero, and three pairs or more that weigh. From the rotation and the scale that are found the
   shift and the residual follow, and the answer is given. Link with -lm. */

#ifndef SEEONE_ALIGNMENT_H
#define SEEONE_ALIGNMENT_H

#include "seeone_plugin.h"
#include <math.h>
#include <string.h>

/* The question. Point i is source[3 * i], source[3 * i + 1], source[3 * i + 2], metres. */
typedef struct {
    uint64_t count;
    const double *source, *target, *weight;
    double scale;                              /* the fixed one; 0 for any */
    double total;                              /* of the weights */
    double source_middle[3], target_middle[3]; /* weighted */
} SeeonePairs;

/* The answer: source -> target turns by the unit quaternion x, y, z, w and scales. */
typedef struct {
    double turn[4], scale;
    double inliers;   /* their share, 0 to 1 */
    double condition; /* 0 for points on one line, which tell no rotation */
} SeeoneFound;

/* Ends a call with `status` and why. */
static inline SeeoneStatus seeone_refuse(SeeoneMessage *message, SeeoneStatus status,
                                         const char *why) {
    message->length = strlen(why) < message->capacity ? strlen(why) : message->capacity;
    memcpy(message->data, why, message->length);
    return status;
}

/* The list at *cell, of `width` numbers an element, which it steps over; NULL for one cut off. */
static inline const double *seeone_list(const uint64_t **cell, const uint64_t *end, uint64_t width,
                                        uint64_t *count) {
    const double *first = (const double *)(*cell + 1);
    if (*cell >= end || **cell > (uint64_t)(end - *cell - 1) / width) return NULL;
    *count = **cell;
    *cell += 1 + *count * width;
    return first;
}

/* Reads and checks the question. */
static inline SeeoneStatus seeone_pairs(SeeoneSpan_u64 request, SeeonePairs *pairs,
                                        SeeoneMessage *message) {
    const uint64_t *cell = request.data, *end = request.data + request.len;
    uint64_t targets = 0, weights = 0, weighing = 0;
    memset(pairs, 0, sizeof *pairs);
    pairs->source = seeone_list(&cell, end, 3, &pairs->count);
    pairs->target = pairs->source ? seeone_list(&cell, end, 3, &targets) : NULL;
    pairs->weight = pairs->target ? seeone_list(&cell, end, 1, &weights) : NULL;
    if (!pairs->weight || cell >= end || end - cell != 1 + (*cell != 0))
        return seeone_refuse(message, SeeoneStatus_INTERNAL, "a message is cut off");
    if (pairs->count != targets || pairs->count != weights)
        return seeone_refuse(message, SeeoneStatus_INPUT, "lengths differ");
    if (*cell) memcpy(&pairs->scale, cell + 1, sizeof pairs->scale);
    if (*cell && !(isfinite(pairs->scale) && pairs->scale > 0))
        return seeone_refuse(message, SeeoneStatus_INPUT, "no scale");
    for (uint64_t i = 0; i < pairs->count; i++) {
        double weight = pairs->weight[i];
        int sound = isfinite(weight) && weight >= 0;
        for (int j = 0; j < 3; j++) {
            double from = pairs->source[3 * i + j], to = pairs->target[3 * i + j];
            sound = sound && isfinite(from) && isfinite(to);
            pairs->source_middle[j] += weight * from, pairs->target_middle[j] += weight * to;
        }
        if (!sound) return seeone_refuse(message, SeeoneStatus_INPUT, "a pair is not finite");
        weighing += weight > 0, pairs->total += weight;
    }
    if (weighing < 3) return seeone_refuse(message, SeeoneStatus_INPUT, "fewer than three pairs");
    for (int j = 0; j < 3; j++)
        pairs->source_middle[j] /= pairs->total, pairs->target_middle[j] /= pairs->total;
    return SeeoneStatus_OK;
}

/* The rotation matrix of the unit quaternion x, y, z, w. */
static inline void seeone_rotation(const double turn[4], double matrix[3][3]) {
    double x = turn[0], y = turn[1], z = turn[2], w = turn[3];
    double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                         {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                         {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    memcpy(matrix, rows, sizeof rows);
}

/* Gives the answer, with the shift and the weighted root mean square residual that follow. */
static inline void seeone_give(const SeeoneAnswer *answer, const SeeonePairs *pairs,
                               const SeeoneFound *found) {
    const double *turn = found->turn, scale = found->scale;
    double matrix[3][3], square = 0;
    seeone_rotation(turn, matrix);
    double cells[11] = {0, 0, 0, turn[0], turn[1], turn[2], turn[3], scale, 0, found->inliers,
                        found->condition};
    for (int r = 0; r < 3; r++) {
        cells[r] = pairs->target_middle[r];
        for (int c = 0; c < 3; c++) cells[r] -= scale * matrix[r][c] * pairs->source_middle[c];
    }
    for (uint64_t i = 0; i < pairs->count; i++)
        for (int r = 0; r < 3; r++) {
            double off = cells[r] - pairs->target[3 * i + r];
            for (int c = 0; c < 3; c++) off += scale * matrix[r][c] * pairs->source[3 * i + c];
            square += pairs->weight[i] * off * off / pairs->total;
        }
    cells[8] = sqrt(square);
    uint64_t words[11];
    memcpy(words, cells, sizeof words);
    answer->give(answer->target, (SeeoneSpan_u64){words, 11});
}

/* Makes the library's one plugin of `align`, which keeps nothing between calls. */
#define SEEONE_ALIGNMENT(plugin_name, plugin_version, align)                                       \
    static SeeoneStatus seeone_create(SeeoneSpan_u64 setup, SeeoneService world, void **instance,  \
                                      SeeoneMessage *message) {                                    \
        static char nothing;                                                                       \
        (void)setup, (void)world, (void)message;                                                   \
        *instance = &nothing;                                                                      \
        return SeeoneStatus_OK;                                                                    \
    }                                                                                              \
    static void seeone_release(void *instance) { (void)instance; }                                 \
    static SeeoneStatus seeone_call(void *instance, uint64_t method, SeeoneSpan_u64 request,       \
                                    SeeoneSpan_Service lent, const SeeoneAnswer *answer,           \
                                    SeeoneMessage *message) {                                      \
        SeeonePairs pairs;                                                                         \
        SeeoneFound found = {{0, 0, 0, 1}, 1, 1, 1};                                               \
        (void)instance, (void)lent;                                                                \
        if (method != SeeoneMethod_Align)                                                          \
            return seeone_refuse(message, SeeoneStatus_INTERNAL, "an alignment is asked to align"); \
        SeeoneStatus status = seeone_pairs(request, &pairs, message);                              \
        if (status == SeeoneStatus_OK) status = align(&pairs, &found, message);                    \
        if (status == SeeoneStatus_OK) seeone_give(answer, &pairs, &found);                        \
        return status;                                                                             \
    }                                                                                              \
    static const SeeoneTable SEEONE_TABLE = {                                                      \
        .header = {.magic = SEEONE_MAGIC, .abi_major = SEEONE_ABI_MAJOR,                           \
                   .abi_minor = SEEONE_ABI_MINOR, .size = sizeof(SeeoneTable),                     \
                   .kind = SEEONE_KIND_ALIGNMENT,                                                  \
                   .name = {(const uint8_t *)plugin_name, sizeof plugin_name - 1},                 \
                   .version = {(const uint8_t *)plugin_version, sizeof plugin_version - 1},        \
                   .build_id = {(const uint8_t *)"C", 1}},                                         \
        .create = seeone_create, .call = seeone_call, .release = seeone_release,                   \
    };                                                                                             \
    const SeeoneHeader *seeone_plugin(uint32_t index) {                                            \
        return index == 0 ? &SEEONE_TABLE.header : NULL;                                           \
    }

#endif /* SEEONE_ALIGNMENT_H */
