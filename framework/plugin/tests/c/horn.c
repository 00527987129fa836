/* An alignment in C: Horn's closed form, whose rotation is found by squaring. */
#include "seeone_plugin.h"
#include <math.h>
#include <string.h>

static SeeoneStatus refuse(SeeoneMessage *message, SeeoneStatus status, const char *text) {
    message->length = strlen(text) < message->capacity ? strlen(text) : message->capacity;
    memcpy(message->data, text, message->length);
    return status;
}

/* The list at *cell, of `width` numbers an element; steps over it. NULL when it is cut off. */
static const double *list(const uint64_t **cell, const uint64_t *end, uint64_t width, uint64_t *n) {
    const double *first = (const double *)(*cell + 1);
    if (*cell >= end || **cell > (uint64_t)(end - *cell - 1) / width) return NULL;
    *n = **cell;
    *cell += 1 + *n * width;
    return first;
}

static SeeoneStatus create(SeeoneSpan_u64 setup, SeeoneService world, void **instance,
                           SeeoneMessage *message) {
    static char nothing;
    (void)setup, (void)world, (void)message;
    *instance = &nothing;
    return SeeoneStatus_OK;
}

static void release(void *instance) { (void)instance; }

static SeeoneStatus call(void *instance, uint64_t method, SeeoneSpan_u64 request,
                         SeeoneSpan_Service lent, const SeeoneAnswer *answer,
                         SeeoneMessage *message) {
    const uint64_t *cell = request.data, *end = request.data + request.len;
    uint64_t n, m, k, weighing = 0;
    (void)instance, (void)lent;
    if (method != SeeoneMethod_Align) return refuse(message, SeeoneStatus_INTERNAL, "not a method");
    const double *a = list(&cell, end, 3, &n), *b = a ? list(&cell, end, 3, &m) : NULL;
    const double *w = b ? list(&cell, end, 1, &k) : NULL;
    if (!w || cell >= end) return refuse(message, SeeoneStatus_INTERNAL, "a message is cut off");
    double fixed = *cell ? *(const double *)(cell + 1) : 1.0, total = 0, ca[3] = {0}, cb[3] = {0};
    if (n != m || n != k) return refuse(message, SeeoneStatus_INPUT, "lengths differ");
    if (!isfinite(fixed) || fixed <= 0) return refuse(message, SeeoneStatus_INPUT, "no scale");
    for (uint64_t i = 0; i < n; i++) {
        int finite = isfinite(w[i]) && w[i] >= 0;
        for (int j = 0; j < 3; j++) finite &= isfinite(a[3 * i + j]) && isfinite(b[3 * i + j]);
        if (!finite) return refuse(message, SeeoneStatus_INPUT, "a pair is not finite");
        weighing += w[i] > 0, total += w[i];
        for (int j = 0; j < 3; j++) ca[j] += w[i] * a[3 * i + j], cb[j] += w[i] * b[3 * i + j];
    }
    if (weighing < 3) return refuse(message, SeeoneStatus_INPUT, "fewer than three pairs");
    double s[3][3] = {{0}}, q[3][3] = {{0}}, ra = 0, square = 0, norm;
    for (uint64_t i = 0; i < n; i++)
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++) {
                double x = a[3 * i + r] - ca[r] / total, y = a[3 * i + c] - ca[c] / total;
                s[r][c] += w[i] * x * (b[3 * i + c] - cb[c] / total);
                q[r][c] += w[i] * x * y;
            }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) ra += r == c ? q[r][c] : 0, square += q[r][c] * q[r][c];
    double spread = 1 - square / (ra * ra); /* zero for points on one line */
    if (!(spread > 1e-9)) return refuse(message, SeeoneStatus_INPUT, "all points on one line");
    double p[4][4] = {{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
                      {0, s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
                      {0, 0, s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
                      {0, 0, 0, s[2][2] - s[0][0] - s[1][1]}};
    for (int r = 0; r < 4; r++) for (int c = 0; c < r; c++) p[r][c] = p[c][r];
    norm = 0;
    for (int r = 0; r < 4; r++) for (int c = 0; c < 4; c++) norm += p[r][c] * p[r][c];
    for (int r = 0; r < 4; r++) p[r][r] += sqrt(norm); /* no eigenvalue below zero */
    for (int round = 0; round < 12; round++) {         /* to the power of 4096 */
        double next[4][4] = {{0}};
        norm = 0;
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++) {
                for (int j = 0; j < 4; j++) next[r][c] += p[r][j] * p[j][c];
                norm += next[r][c] * next[r][c];
            }
        for (int r = 0; r < 4; r++) for (int c = 0; c < 4; c++) p[r][c] = next[r][c] / sqrt(norm);
    }
    int best = 0; /* every column is the first eigenvector; the longest is the most exact */
    for (int c = 1; c < 4; c++) if (p[c][c] > p[best][best]) best = c;
    double e[4];
    norm = 0;
    for (int r = 0; r < 4; r++) e[r] = p[r][best], norm += e[r] * e[r];
    for (int r = 0; r < 4; r++) e[r] /= sqrt(norm);
    double u = e[0], x = e[1], y = e[2], z = e[3];
    double R[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - u * z), 2 * (x * z + u * y)},
                      {2 * (x * y + u * z), 1 - 2 * (x * x + z * z), 2 * (y * z - u * x)},
                      {2 * (x * z - u * y), 2 * (y * z + u * x), 1 - 2 * (x * x + y * y)}};
    double scale = 0, shift[3], residual = 0;
    for (int r = 0; r < 3; r++) for (int c = 0; c < 3; c++) scale += R[c][r] * s[r][c] / ra;
    if (*cell) scale = fixed;
    if (!(scale > 0)) return refuse(message, SeeoneStatus_INPUT, "the targets coincide");
    for (int r = 0; r < 3; r++) {
        shift[r] = cb[r] / total;
        for (int c = 0; c < 3; c++) shift[r] -= scale * R[r][c] * ca[c] / total;
    }
    for (uint64_t i = 0; i < n; i++)
        for (int r = 0; r < 3; r++) {
            double off = shift[r] - b[3 * i + r];
            for (int c = 0; c < 3; c++) off += scale * R[r][c] * a[3 * i + c];
            residual += w[i] * off * off / total;
        }
    double found[11] = {shift[0], shift[1], shift[2], x, y, z, u, scale, sqrt(residual), 1, spread};
    uint64_t cells[11];
    memcpy(cells, found, sizeof cells);
    answer->give(answer->target, (SeeoneSpan_u64){cells, 11});
    return SeeoneStatus_OK;
}

static const SeeoneTable TABLE = {
    .header = {.magic = SEEONE_MAGIC, .abi_major = SEEONE_ABI_MAJOR, .abi_minor = SEEONE_ABI_MINOR,
               .size = sizeof(SeeoneTable), .kind = SEEONE_KIND_ALIGNMENT,
               .name = {(const uint8_t *)"horn-c", 6}, .version = {(const uint8_t *)"1", 1},
               .build_id = {(const uint8_t *)"C", 1}},
    .create = create, .call = call, .release = release,
};

const SeeoneHeader *seeone_plugin(uint32_t index) { return index == 0 ? &TABLE.header : NULL; }
