//! Matrix products on slices, for use inside fused operations.
//!
//! candle multiplies tensors only; a fused operation multiplies pieces of its scratch
//! memory, and copying those into tensors would cost more than the product.

/// A matrix read from a slice.
#[derive(Clone, Copy)]
pub struct Matrix<'a> {
    data: &'a [f32],
    rows: usize,
    columns: usize,
    row_stride: usize,
    column_stride: usize,
}

impl<'a> Matrix<'a> {
    /// `rows` x `columns` numbers, row by row, from the start of `data`.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn new(data: &'a [f32], rows: usize, columns: usize) -> Self {
        Self::strided(data, rows, columns, columns)
    }

    /// As [`Matrix::new`], with `row_stride` numbers from one row's start to the next.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn strided(data: &'a [f32], rows: usize, columns: usize, row_stride: usize) -> Self {
        assert!(fits(data.len(), rows, columns, row_stride), "matrix outside its slice");
        Self { data, rows, columns, row_stride, column_stride: 1 }
    }

    /// The transposed matrix, without moving a number.
    pub fn transposed(self) -> Self {
        Self {
            rows: self.columns,
            columns: self.rows,
            row_stride: self.column_stride,
            column_stride: self.row_stride,
            ..self
        }
    }
}

/// A row-major matrix written to a slice.
pub struct MatrixMut<'a> {
    data: &'a mut [f32],
    rows: usize,
    columns: usize,
    row_stride: usize,
}

impl<'a> MatrixMut<'a> {
    /// `rows` x `columns` numbers, row by row, from the start of `data`.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn new(data: &'a mut [f32], rows: usize, columns: usize) -> Self {
        Self::strided(data, rows, columns, columns)
    }

    /// As [`MatrixMut::new`], with `row_stride` numbers from one row's start to the next.
    ///
    /// # Panics
    /// When `data` is too short.
    pub fn strided(data: &'a mut [f32], rows: usize, columns: usize, row_stride: usize) -> Self {
        assert!(fits(data.len(), rows, columns, row_stride), "matrix outside its slice");
        Self { data, rows, columns, row_stride }
    }
}

fn fits(length: usize, rows: usize, columns: usize, row_stride: usize) -> bool {
    rows == 0
        || columns == 0
        || (columns <= row_stride && (rows - 1) * row_stride + columns <= length)
}

/// What happens to the numbers that the target held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Store {
    /// They are overwritten.
    Replace,
    /// The product is added to them.
    Add,
}

/// `target (+)= a * b` on the calling thread.
///
/// # Panics
/// When the shapes do not agree.
pub fn multiply(target: MatrixMut<'_>, a: Matrix<'_>, b: Matrix<'_>, store: Store) {
    assert!(
        target.rows == a.rows && target.columns == b.columns && a.columns == b.rows,
        "shapes of a product do not agree"
    );
    if target.rows == 0 || target.columns == 0 {
        return;
    }
    gemm_on_checked(target, a, b, store);
}

#[allow(unsafe_code, reason = "gemm takes pointers; every extent was checked on construction")]
fn gemm_on_checked(target: MatrixMut<'_>, a: Matrix<'_>, b: Matrix<'_>, store: Store) {
    // SAFETY: `fits` held when each of the three was made, and transposing keeps the set
    // of addressed numbers, so all of them lie inside their slices; `target` is borrowed
    // uniquely, so it does not overlap the others; `multiply` compared the shapes.
    unsafe {
        gemm::gemm(
            target.rows,
            target.columns,
            a.columns,
            target.data.as_mut_ptr(),
            1,
            target.row_stride as isize,
            store == Store::Add,
            a.data.as_ptr(),
            a.column_stride as isize,
            a.row_stride as isize,
            b.data.as_ptr(),
            b.column_stride as isize,
            b.row_stride as isize,
            1.0,
            1.0,
            false,
            false,
            false,
            gemm::Parallelism::None,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiplies_transposes_strides_and_accumulates() {
        let a: Vec<f32> = (0..6).map(|v| v as f32).collect(); // 2 x 3
        let b: Vec<f32> = (0..8).map(|v| 1.0 - v as f32).collect(); // 2 x 3 inside rows of 4
        let mut c = vec![1.0; 4];
        let right = Matrix::strided(&b, 2, 3, 4).transposed();
        multiply(MatrixMut::new(&mut c, 2, 2), Matrix::new(&a, 2, 3), right, Store::Add);
        assert_eq!(c, [1.0 - 2.0, 1.0 - 14.0, 1.0 - 2.0, 1.0 - 50.0]);
        multiply(MatrixMut::new(&mut c, 2, 2), Matrix::new(&a, 2, 3), right, Store::Replace);
        assert_eq!(c, [-2.0, -14.0, -2.0, -50.0]);
    }

    #[test]
    #[should_panic(expected = "outside its slice")]
    fn refuses_a_slice_that_is_too_short() {
        let _ = Matrix::strided(&[0.0; 7], 2, 4, 4);
    }
}
