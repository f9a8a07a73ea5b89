"""What reports, plots and files of pictures share: motion, views, chains of blocks, drawings of them."""
