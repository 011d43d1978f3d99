/* One triangle of C := alpha op(A) op(B) + beta C, in blocks of columns by dgemm.

   The interface is that of the BLAS extension dgemmt of Intel's and OpenBLAS' libraries; arrays are stored by columns.
   reference_fe/solver/triangular_product.py says why it is here. */

typedef void (*dgemm_t)(const char *, const char *, const int *, const int *, const int *, const double *, const double *,
                        const int *, const double *, const int *, const double *, double *, const int *);

enum { BLOCK = 48 };

dgemm_t dgemmt_product = 0; /* dgemm of the BLAS in use, set before the first call */
long dgemmt_calls = 0;

static int is(const char *option, char letter) { return (*option & 0xDF) == letter; }

static void add_triangle(int upper, int width, const double *product, double beta, double *c, long ldc)
{
    for (int j = 0; j < width; ++j) {
        const int first = upper ? 0 : j, end = upper ? j + 1 : width;
        for (int i = first; i < end; ++i)
            c[j * ldc + i] = product[j * BLOCK + i] + (beta == 0.0 ? 0.0 : beta * c[j * ldc + i]);
    }
}

void dgemmt_(const char *uplo, const char *transa, const char *transb, const int *n, const int *k, const double *alpha,
             const double *a, const int *lda, const double *b, const int *ldb, const double *beta, double *c,
             const int *ldc)
{
    const int upper = is(uplo, 'U'), block = BLOCK;
    const long row_of_a = is(transa, 'N') ? 1 : *lda, column_of_b = is(transb, 'N') ? *ldb : 1;
    const double zero = 0.0;
    double product[BLOCK * BLOCK];

    ++dgemmt_calls;
    for (int j = 0; j < *n; j += BLOCK) {
        const int width = *n - j < BLOCK ? *n - j : BLOCK;
        const int first = upper ? 0 : j + width, rows = upper ? j : *n - first;
        const double *columns = b + j * column_of_b;
        double *target = c + (long)j * *ldc;
        if (rows > 0)
            dgemmt_product(transa, transb, &rows, &width, k, alpha, a + first * row_of_a, lda, columns, ldb, beta,
                           target + first, ldc);
        dgemmt_product(transa, transb, &width, &width, k, alpha, a + j * row_of_a, lda, columns, ldb, &zero, product,
                       &block);
        add_triangle(upper, width, product, *beta, target + j, *ldc);
    }
}
