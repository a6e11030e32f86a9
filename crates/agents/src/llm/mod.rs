pub mod answers; pub mod batch; pub mod extract; pub mod live; pub mod question;
